#include "hammer_loads/settings/parameter_reader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hammer_loads {
namespace {

using Lines = std::vector<std::string>;

ParameterReader readerOf(const std::string& yaml, const std::string& origin = "x.yaml") {
  std::vector<std::string> problems;
  const YAML::Node node = YAML::Load(yaml);
  ParameterReader reader(node.IsNull() ? ParameterMap{} : parameterMap(node, origin, problems).value());
  EXPECT_EQ(problems, Lines{});
  return reader;
}

TEST(ParameterReader, ReadsEveryType) {
  ParameterReader reader = readerOf("a: 1.5\nb: 2\nc: 7\nd: false\ne: word\nf: [p, q]\ng: two");
  EXPECT_EQ(reader.number("a", "m", NumberRule::positive()), 1.5);
  EXPECT_EQ(reader.number("b", "m", NumberRule::within(-2.0, 2.0)), 2.0);
  EXPECT_EQ(reader.integer("c", "", 0, 7), 7);
  EXPECT_FALSE(reader.boolean("d"));
  EXPECT_EQ(reader.text("e"), "word");
  EXPECT_EQ(reader.names("f"), (std::vector<std::string>{"p", "q"}));
  constexpr std::array<Named<int>, 2> kChoices{{{"one", 1}, {"two", 2}}};
  EXPECT_EQ(reader.choice("g", kChoices), 2);
  reader.reportUnknownKeys();
  EXPECT_EQ(reader.problems(), Lines{});
  EXPECT_EQ(reader.yaml(), "a: 1.5\nb: 2.0\nc: 7\nd: false\ne: \"word\"\nf: [\"p\", \"q\"]\ng: \"two\"\n");
}

struct NumberCase {
  const char* text;
  NumberRule rule;
  const char* problem;  ///< nullptr: accepted
};

TEST(ParameterReader, JudgesNumbersByTheirRule) {
  const NumberRule any = NumberRule::any(), positive = NumberRule::positive(), not_negative = NumberRule::notNegative();
  const NumberRule within = NumberRule::within(-1.0, 2.5);
  const NumberCase cases[] = {{"-3", any, nullptr},
                              {"0.001", positive, nullptr},
                              {"0", not_negative, nullptr},
                              {"-1", within, nullptr},
                              {"2.5", within, nullptr},
                              {"0", positive, "k: 0 m, must be a finite number > 0 (x.yaml:1)"},
                              {"-0.5", positive, "k: -0.5 m, must be a finite number > 0 (x.yaml:1)"},
                              {"-1e-9", not_negative, "k: -1e-9 m, must be a finite number >= 0 (x.yaml:1)"},
                              {"2.6", within, "k: 2.6 m, must be a number in [-1.0, 2.5] (x.yaml:1)"},
                              {".nan", within, "k: .nan m, must be a number in [-1.0, 2.5] (x.yaml:1)"},
                              {".nan", any, "k: .nan m, must be a finite number (x.yaml:1)"},
                              {".inf", positive, "k: .inf m, must be a finite number > 0 (x.yaml:1)"},
                              {"1e999", any, "k: 1e999 m, must be a finite number (x.yaml:1)"},
                              {"\"1.5\"", any, "k: \"1.5\" m, must be a finite number (x.yaml:1)"},
                              {"true", any, "k: true m, must be a finite number (x.yaml:1)"},
                              {"[1]", any, "k: (a list) m, must be a finite number (x.yaml:1)"},
                              {"", any, "k: (empty) m, must be a finite number (x.yaml:1)"}};
  for (const NumberCase& c : cases) {
    ParameterReader reader = readerOf(std::string("k: ") + c.text);
    const double read = reader.number("k", "m", c.rule);
    EXPECT_EQ(reader.problems(), c.problem == nullptr ? Lines{} : Lines{c.problem});
    EXPECT_EQ(std::isnan(read), c.problem != nullptr) << c.text;
    EXPECT_EQ(reader.yaml().empty(), c.problem != nullptr) << c.text;
  }
}

TEST(ParameterReader, RefusesWrongTypesOfEveryKind) {
  ParameterReader reader = readerOf("i: 1.0\nj: 9\nb: 1\nt: 5\nu: \"\"\nn: [a, a]\nm: [a, \"\"]\no: a\nc: three\nd: 1");
  reader.integer("i", "MB", 0, 8);
  reader.integer("j", "MB", 0, 8);
  reader.boolean("b");
  reader.text("t");
  reader.text("u");
  for (const char* key : {"n", "m", "o"}) reader.names(key);
  constexpr std::array<Named<int>, 2> kChoices{{{"one", 1}, {"two", 2}}};
  EXPECT_EQ(reader.choice("c", kChoices), 1);
  reader.choice("d", kChoices);
  EXPECT_EQ(reader.problems(),
            (Lines{"i: 1.0 MB, must be an integer in [0, 8] (x.yaml:1)",
                   "j: 9 MB, must be an integer in [0, 8] (x.yaml:2)", "b: 1, must be true or false (x.yaml:3)",
                   "t: 5, must be a text, not empty (x.yaml:4)", "u: \"\", must be a text, not empty (x.yaml:5)",
                   "n: (a list), must be a list of different names (x.yaml:6)",
                   "m: (a list), must be a list of different names (x.yaml:7)",
                   "o: a, must be a list of different names (x.yaml:8)", "c: three, must be one of one, two (x.yaml:9)",
                   "d: 1, must be one of one, two (x.yaml:10)"}));
  EXPECT_EQ(reader.yaml(), "");
}

TEST(ParameterReader, NamesTheNearestKeyForAnUnknownOne) {
  ParameterReader reader = readerOf("crank_lenght_m: 1\nsomething_else: 2\n\"two\\nlines\": 3");
  reader.number("crank_length_m", "m", NumberRule::positive());
  reader.number("rod_length_m", "m", NumberRule::positive());
  reader.reportUnknownKeys();
  ASSERT_EQ(reader.problems().size(), 5U);
  EXPECT_EQ(reader.problems()[2], "crank_lenght_m: unknown key, perhaps crank_length_m was meant (x.yaml:1)");
  EXPECT_EQ(reader.problems()[3], "something_else: unknown key (x.yaml:2)");
  EXPECT_EQ(reader.problems()[4], "two lines: unknown key (x.yaml:3)");
}

}  // namespace
}  // namespace hammer_loads
