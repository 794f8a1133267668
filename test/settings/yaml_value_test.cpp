#include "hammer_loads/settings/yaml_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hammer_loads {
namespace {

YAML::Node value(const std::string& text) { return YAML::Load("key: " + text)["key"]; }

TEST(YamlValue, NumbersArePlainDecimals) {
  for (const auto& [text, number] : std::vector<std::pair<std::string, double>>{
           {"1.5", 1.5}, {"-2", -2.0}, {"+.5", 0.5}, {"5e-4", 5e-4}, {"1.0E+3", 1000.0}, {"010", 10.0}, {"7.", 7.0}})
    EXPECT_EQ(asNumber(value(text)), number) << text;
  EXPECT_TRUE(std::isnan(asNumber(value(".nan")).value()));
  EXPECT_EQ(asNumber(value("-.inf")), -std::numeric_limits<double>::infinity());
}

TEST(YamlValue, NothingElseIsANumber) {
  for (const char* text : {"\"1.5\"", "'1.5'", "true", "~", "", "0x10", "1,5", "1.5 m", "1.5e", "1-2", "1.2.3", "nan",
                           "inf", "1_000", "1:30", "[1.5]", "{a: 1.5}", "!!str 1.5"})
    EXPECT_FALSE(asNumber(value(text)).has_value()) << text;
}

TEST(YamlValue, IntegersHaveNoPointAndFit) {
  EXPECT_EQ(asInteger(value("-12")), -12);
  EXPECT_EQ(asInteger(value("9223372036854775807")), std::numeric_limits<std::int64_t>::max());
  for (const char* text : {"1.0", "1e3", "9223372036854775808", "\"1\"", "one", "--1", "+", "true", "[1]"})
    EXPECT_FALSE(asInteger(value(text)).has_value()) << text;
}

TEST(YamlValue, BooleansAreWords) {
  for (const char* text : {"true", "True", "TRUE", "yes", "on"}) EXPECT_EQ(asBoolean(value(text)), true) << text;
  for (const char* text : {"false", "False", "no", "off"}) EXPECT_EQ(asBoolean(value(text)), false) << text;
  for (const char* text : {"1", "0", "\"true\"", "maybe", "~", "[true]"})
    EXPECT_FALSE(asBoolean(value(text)).has_value()) << text;
}

TEST(YamlValue, TextsAreQuotedOrMeanNothingElse) {
  EXPECT_EQ(asText(value("rocker")), "rocker");
  EXPECT_EQ(asText(value("none")), "none");
  EXPECT_EQ(asText(value("\"1.5\"")), "1.5");
  EXPECT_EQ(asText(value("'true'")), "true");
  EXPECT_EQ(asText(value("\"\"")), "");
  for (const char* text : {"1.5", "7", "true", "off", "~", "", "[a]", "{a: b}"})
    EXPECT_FALSE(asText(value(text)).has_value()) << text;
}

TEST(YamlValue, ListsOfTexts) {
  EXPECT_EQ(asTexts(value("[a, \"b c\"]")), (std::vector<std::string>{"a", "b c"}));
  EXPECT_EQ(asTexts(value("[]")), std::vector<std::string>{});
  for (const char* text : {"a", "[a, 1]", "[[a]]", "{a: b}"}) EXPECT_FALSE(asTexts(value(text)).has_value()) << text;
}

TEST(YamlValue, NumberTextIsShortAndReadsBackTheSame) {
  EXPECT_EQ(numberText(0.048), "0.048");
  EXPECT_EQ(numberText(3.0), "3.0");
  EXPECT_EQ(numberText(5e-5), "5.0e-05");
  EXPECT_EQ(numberText(0.0015339807878856412), "0.0015339807878856412");
  double number = 1.0 / 3.0;
  for (int i = 0; i < 2000; ++i, number *= -1.37) EXPECT_EQ(asNumber(value(numberText(number))), number);
}

TEST(YamlValue, QuotedTextReadsBackTheSame) {
  for (const char* text : {"", "plain", "with \"quotes\" and \\", "two\nlines\tand\x01", "a: b # c", "5", "\xc3\xa4"})
    EXPECT_EQ(asText(value(quotedText(text))), text);
}

TEST(YamlValue, DescriptionsFitOnOneLine) {
  EXPECT_EQ(describe(value("-1.50")), "-1.50");
  EXPECT_EQ(describe(value("\"1\\n2\"")), "\"1\\x0a2\"");
  EXPECT_EQ(describe(value("")), "(empty)");
  EXPECT_EQ(describe(value("[1]")), "(a list)");
  EXPECT_EQ(describe(value("{a: 1}")), "(a map)");
  EXPECT_LT(describe(value(std::string(10000, 'x'))).size(), 70U);
}

}  // namespace
}  // namespace hammer_loads
