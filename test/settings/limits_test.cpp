// Limits: values read, their sources, refusals.
#include "hammer_loads/settings/limits.h"

#include <gtest/gtest.h>

#include "hammer_loads/settings/load.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

using Lines = std::vector<std::string>;

const std::string kSpotsOfLimits =
    "hot_spots: [toe, heel]\ntoe_loads: [hull_z]\ntoe_hull_z_area_m2: 0.01\ntoe_full_scale_least_MPa: -300.0\n"
    "toe_full_scale_greatest_MPa: 300.0\nheel_loads: [hull_z]\nheel_hull_z_area_m2: 0.01\n"
    "heel_full_scale_least_MPa: -300.0\nheel_full_scale_greatest_MPa: 300.0\n"
    "toe_sn_knee_range_MPa: 52.6\ntoe_sn_knee_cycles: 1.0e+7\ntoe_sn_slope: 3\ntoe_sn_slope_below: 5\n"
    "toe_mean_stress: none\n";

Checked<Settings> limitsFrom(const std::string& text) {
  const test::TemporaryFile file(text);
  return loadFiles(configDirectory(), {file.path()});
}

Lines limitProblems(const std::string& text) {
  Lines lines;
  for (const std::string& line : limitsFrom(text).problems) lines.push_back(line.substr(0, line.rfind(" (")));
  return lines;
}

TEST(Limits, ShippedExampleHasTheLimitsOfItsComments) {
  const Checked<Settings> settings = limitsFrom("limits_file: " + configDirectory() + "/limits.yaml");
  ASSERT_TRUE(settings.value) << settings.problems.front();
  ASSERT_EQ(settings.value->limits.size(), 5U);
  for (const Limit& limit : settings.value->limits) {
    EXPECT_FALSE(limit.exceeds(limit.warn, limit.error)) << limit.name;
    EXPECT_NE(limit.warn, limit.error) << limit.name;
  }
}

/// The run_info in a log has the parameters in force. No file is needed when the log is processed.
TEST(Limits, NeedTheFileNoMoreOnceInForce) {
  const test::TemporaryFile limits("limit_peak_force_warn_N: 9000\nlimit_toe_damage_per_hour_error: 0.01\n");
  const Checked<Settings> settings =
      limitsFrom(kSpotsOfLimits + "limits_file: " + limits.path() + "\nlimit_peak_force_error_N: 9500\n");
  ASSERT_TRUE(settings.value) << settings.problems.front();
  EXPECT_EQ(settings.value->yaml.find("limits_file"), std::string::npos);
  const Checked<Settings> again = limitsFrom(settings.value->yaml);
  for (const Checked<Settings>* read : {&settings, &again}) {
    ASSERT_EQ(read->value->limits.size(), 2U);
    const Limit &force = read->value->limits[0], &damage = read->value->limits[1];
    EXPECT_EQ(force.name, "peak_force");
    EXPECT_EQ(force.warn, 9000.0);
    EXPECT_EQ(force.error, 9500.0);
    EXPECT_EQ(damage.channel, "stress/toe");
    EXPECT_EQ(damage.error, 0.01);
    EXPECT_TRUE(std::isnan(damage.warn));
  }
}

TEST(Limits, AreNamedIfTheyCannotBe) {
  EXPECT_EQ(limitProblems("limit_peak_force_warn_N: -1"),
            Lines{"limit_peak_force_warn_N: -1 N, must be a finite number >= 0"});
  EXPECT_EQ(limitProblems("limit_peak_force_warn_kN: 9"),
            Lines{"limit_peak_force_warn_kN: unknown key, perhaps limit_peak_force_warn_N was meant"});
  EXPECT_EQ(limitProblems("limit_peak_force_warn_N: 9000\nlimit_peak_force_error_N: 8000"),
            Lines{"limit_peak_force_error_N: 8000.0 N, must be >= limit_peak_force_warn_N (9000.0)"});
  EXPECT_EQ(limitProblems("limit_blow_energy_least_warn_J: 600\nlimit_blow_energy_least_error_J: 700"),
            Lines{"limit_blow_energy_least_error_J: 700.0 J, must be <= limit_blow_energy_least_warn_J (600.0)"});
  EXPECT_EQ(limitProblems(kSpotsOfLimits + "limit_heel_damage_per_hour_warn: 1e-4").size(), 1U)
      << "it has no S-N curve";
  EXPECT_EQ(limitProblems("limits_file: 3.5"), Lines{"limits_file: 3.5, must be a file, or none"});
  EXPECT_EQ(limitProblems("limits_file: /no/such"), Lines{"/no/such: cannot be read: No such file or directory"});
}

}  // namespace
}  // namespace hammer_loads
