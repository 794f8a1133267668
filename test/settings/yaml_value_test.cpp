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

}  // namespace
}  // namespace hammer_loads
