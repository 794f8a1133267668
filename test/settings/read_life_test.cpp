// life.yaml: values read and values refused.
#include <gtest/gtest.h>

#include "hammer_loads/settings/load.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads {
namespace {

using Lines = std::vector<std::string>;

ParameterMap mapOf(const std::string& yaml) {
  std::vector<std::string> problems;
  return parameterMap(YAML::Load(yaml), {}, problems).value();
}

struct Read {
  life::LifeSettings settings;
  std::vector<std::string> problems;
};

Read read(const std::string& yaml) {
  std::vector<std::string> problems;
  ParameterMap parameters;
  EXPECT_TRUE(addFiles({configDirectory() + "/life.yaml"}, parameters, problems));
  merge(mapOf(yaml), parameters);
  ParameterReader reader(std::move(parameters));
  Read result;
  result.settings = readLifeSettings(reader);
  reader.reportUnknownKeys();
  for (const std::string& line : reader.problems()) result.problems.push_back(line.substr(0, line.rfind(" (")));
  return result;
}

const std::string kToe =
    "hot_spots: [toe]\ntoe_loads: [hull_y, hull_x]\ntoe_hull_y_modulus_m3: 0.002\ntoe_hull_x_area_m2: 0.01\n"
    "toe_full_scale_least_MPa: -300\ntoe_full_scale_greatest_MPa: 300.0\n";
const std::string kCurve =
    "toe_sn_knee_range_MPa: 52.6\ntoe_sn_knee_cycles: 1.0e+7\ntoe_sn_slope: 3\ntoe_sn_slope_below: 5\n";

TEST(ReadLife, ReadsStressByModulusAreaOrCoefficient) {
  const Read plain = read(kToe);
  EXPECT_EQ(plain.problems, std::vector<std::string>{});
  const life::CountedChannel& toe = plain.settings.channels.back();
  EXPECT_EQ(toe.name, "stress/toe");
  EXPECT_EQ(toe.influences.at(0).channel, "hull_wrench/torque_y");
  EXPECT_DOUBLE_EQ(toe.influences.at(0).factor, 5e-4);  // 1 N m over 0.002 m3 is 500 Pa
  EXPECT_DOUBLE_EQ(toe.influences.at(1).factor, 1e-4);
  EXPECT_FALSE(toe.curve);
  const Read direct =
      read(kToe + kCurve + "toe_mean_stress: fkm\ntoe_mean_stress_sensitivity: 0.3\nlife_ledger: /m.sqlite\n");
  EXPECT_EQ(direct.problems, std::vector<std::string>{});
  EXPECT_EQ(direct.settings.channels.back().curve->slopeBelow(), 5.0);
  EXPECT_EQ(direct.settings.channels.back().mean_stress->sensitivity, 0.3);
  EXPECT_EQ(direct.settings.ledger, "/m.sqlite");
  EXPECT_FALSE(read(kToe + kCurve + "toe_mean_stress: none\n").settings.channels.back().mean_stress);
}

TEST(ReadLife, NamesEachFault) {
  const auto problems = [](const std::string& yaml) { return read(yaml).problems; };
  EXPECT_EQ(problems(kToe + "toe_hull_y_MPa_per_unit: 1.0"),
            Lines{"toe_hull_y_MPa_per_unit: must be the only one beside toe_hull_y_modulus_m3 and toe_hull_y_area_m2"});
  EXPECT_EQ(
      problems("hot_spots: [toe]\ntoe_loads: [hull_q]\ntoe_full_scale_least_MPa: 0\ntoe_full_scale_greatest_MPa: 1"),
      Lines{"toe_loads: \"hull_q\", must be among life_channels"});
  EXPECT_EQ(problems("hot_spots: [toe]\ntoe_loads: [hull_x]\ntoe_hull_x_modulus_m3: 1\ntoe_full_scale_least_MPa: 0\n"
                     "toe_full_scale_greatest_MPa: 1"),
            Lines{"toe_hull_x_modulus_m3: given for hull_wrench/force_x, must be for a moment"});
  EXPECT_EQ(problems(kToe + "toe_sn_slope: 3\ntoe_mean_stress: none\n").size(),
            4U);  // a curve's other keys; no use of it
  EXPECT_EQ(problems(kToe + kCurve), Lines{"toe_mean_stress: missing, must be one of none, fkm"});
  EXPECT_EQ(problems("hull_x_full_scale_greatest: -300000.0").size(), 1U);
  EXPECT_EQ(problems("hull_x_channel: hull_wrench/force_z").size(), 1U);
  EXPECT_EQ(problems("life_ledger: m.sqlite"), Lines{"life_ledger: \"m.sqlite\", must be an absolute path, or none"});
  EXPECT_EQ(problems("life_classes: 1").size(), 1U);
  EXPECT_EQ(problems("toe_full_scale_least_MPa: 0").size(), 1U);  // belongs to no hot spot
  EXPECT_EQ(problems("life_channels: []").size(), 9U);            // keys that belong to no channel
}

}  // namespace
}  // namespace hammer_loads
