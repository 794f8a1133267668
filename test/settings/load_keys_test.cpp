// Single keys: each is read, and a bad value gives one line that states what is required.
#include "settings/load_support.h"

namespace hammer_loads {
namespace {

using test::Lines;
using test::loadShippedWith;
using test::problemsOf;
using test::TemporaryFile;

struct BadPair {
  const char* good;
  const char* bad;
  const char* problem;
};

TEST(Load, AcceptsGoodAndRefusesBadPipelineAndLogKeys) {
  const BadPair pairs[] = {
      {"level: linkage", "level: Linkage", "level: Linkage, must be one of pulse, rocker, linkage, elastic, auto"},
      {"level: auto", "tolerance: 0", "tolerance: 0, must be a number in [1.0e-09, 10.0]"},
      {"hull_motion: imu", "hull_motion: model",
       "hull_motion: model, must be unmeasured, fixed or imu without a boom file: its cylinders' oil is the spring"},
      {"output: mean", "output: median", "output: median, must be one of instantaneous, mean"},
      {"output_rate_Hz: 50", "output_rate_Hz: -1", "output_rate_Hz: -1 Hz, must be 0 or a number in [0.001, 10000.0]"},
      {"output_rate_Hz: 1e4", "output_rate_Hz: 1e5",
       "output_rate_Hz: 1e5 Hz, must be 0 or a number in [0.001, 10000.0]"},
      {"torque_std_part: 1", "torque_std_part: 2", "torque_std_part: 2, must be a number in [0.0, 1.0]"},
      {"crank_joint: c", "crank_joint: [c]", "crank_joint: (a list), must be a text, not empty"},
      {"pitch_joints: [a]", "pitch_joints: [a, a]", "pitch_joints: (a list), must be a list of different names"},
      {"pitch_signs: [1, -1, 1]", "pitch_signs: [1, 0, 1]", "pitch_signs: (a list), must be a list of 1 and -1"},
      {"pitch_signs: []", "pitch_signs: [-1, 1]",
       "pitch_signs: 2 numbers, must be one for each of the 3 pitch_joints, or none"},
      {"pitch_offset_rad: -0.4", "pitch_offset_rad: 23", "pitch_offset_rad: 23 rad, must be a number in [-3.2, 3.2]"},
      {"hull_pitch_rad: -0.5", "hull_pitch_rad: steep", "hull_pitch_rad: steep rad, must be a number in [-6.3, 6.3]"},
      {"gravity_m_s2: 0", "gravity_m_s2: -9.8", "gravity_m_s2: -9.8 m/s2, must be a number in [0.0, 100.0]"},
      {"base_roll_rad: -0.1", "base_roll_rad: 2", "base_roll_rad: 2 rad, must be a number in [-1.0, 1.0]"},
      {"boom_stiffness: given", "boom_stiffness: identified",
       "boom_stiffness: identified, must be given without a boom on its cylinders' oil (boom: compliant or auto, and a "
       "boom file)"},
      {"crank_angle_noise_rad: 0", "crank_angle_noise_rad: .nan",
       "crank_angle_noise_rad: .nan rad, must be a number in [0.0, 1.0]"},
      {"stale_after_s: 1", "stale_after_s: 0", "stale_after_s: 0 s, must be a number in [0.001, 10.0]"},
      {"torque_walk_rad_s2: 1", "torque_walk_rad_s2: -1",
       "torque_walk_rad_s2: -1 rad/s2/sqrt(s), must be a number in [0.001, 1000000.0]"},
      {"boom: none", "boom: soft", "boom: soft, must be one of none, rigid, compliant, auto"},
      {"boom_acceleration: difference", "boom_acceleration: true",
       "boom_acceleration: true, must be one of none, difference"},
      {"joint_max_age_s: 0.1", "joint_max_age_s: 0", "joint_max_age_s: 0 s, must be a number in [0.001, 10.0]"},
      {"tf_max_wait_s: 1", "tf_max_wait_s: .inf", "tf_max_wait_s: .inf s, must be a number in [0.001, 60.0]"},
      {"boom_wrench_links: [arm_link, left/gauge_2]", "boom_wrench_links: [arm-link]",
       "boom_wrench_links: arm-link, must be names of a letter first, then letters, digits, _ and /"},
      {"log_enabled: true", "log_enabled: \"true\"", "log_enabled: \"true\", must be true or false"},
      {"log_outputs: per_turn", "log_outputs: per_sample",
       "log_outputs: per_sample, must be one of all, wrench, per_turn, none"},
      {"log_compression: none", "log_compression: bz2", "log_compression: bz2, must be one of none, lz4"},
      {"log_inputs: false", "{log_inputs: false, log_outputs: none}",
       "log_inputs: false, must be true with log_outputs: none; log_enabled: false switches the log off"},
      {"log_prefix: p", "log_prefix: p/q", "log_prefix: \"p/q\", must be a file name's beginning, without /"},
      {"log_total_mb: 0", "log_total_mb: -1", "log_total_mb: -1 MB, must be an integer in [0, 1000000000]"},
      {"log_queue_mb: 1", "log_queue_mb: 1.5", "log_queue_mb: 1.5 MB, must be an integer in [1, 1000000000]"},
      {"gravity_m_s2: 100", "gravity_m_s2: 1e999", "gravity_m_s2: 1e999 m/s2, must be a number in [0.0, 100.0]"},
      {"gravity_m_s2: 9", "gravity_m_s2:", "gravity_m_s2: (empty) m/s2, must be a number in [0.0, 100.0]"},
      {"pitch_joints: []", "pitch_joints: [a, \"\"]", "pitch_joints: (a list), must be a list of different names"},
      {"log_prefix: p", "log_prefix: 5", "log_prefix: 5, must be a text, not empty"},
      {"stale_after_s: 1", "\"two\\nlines\": 1", "two lines: unknown key"},
      {"stale_after_s: 1", "stale_after: 1", "stale_after: unknown key, perhaps stale_after_s was meant"}};
  for (const BadPair& pair : pairs) {
    EXPECT_EQ(problemsOf(pair.good), Lines{}) << pair.good;
    EXPECT_EQ(problemsOf(pair.bad), Lines{std::string(pair.problem) + " (FILE:1)"});
  }
}

TEST(Load, LevelAutoIsChosenAtStartAndReported) {
  const auto loaded = [](const std::string& text) {
    const TemporaryFile file(text);
    return *loadFiles(configDirectory(), {file.path()}).value;
  };
  const Settings strict = loaded("{level: auto, tolerance: 1.0e-6}"), loose = loaded("{level: auto, tolerance: 5.0}");
  EXPECT_EQ(strict.pipeline.level, Level::kElastic);
  EXPECT_EQ(loose.pipeline.level, Level::kRocker);
  ASSERT_EQ(loose.notes.size(), 1U);
  EXPECT_EQ(loose.notes[0].find("level auto: rocker is the cheapest whose difference to elastic is within 5 of what"),
            0U);
  EXPECT_TRUE(loaded("{level: rocker}").notes.empty());
  const auto of_rod = [&](const std::string& output) {  // at level linkage
    const std::string note = loaded("{level: auto" + output + "}").notes[0];
    return std::stod(note.substr(note.find("linkage ") + 8));
  };
  EXPECT_LT(of_rod(", output: mean, output_rate_Hz: 60"), 0.8 * of_rod(""));
}

TEST(Load, CrankSensorsPlaceIsRead) {
  const TemporaryFile file(
      "crank_zero_rad: 0.4\ncrank_direction: -1\ncrank_eccentricity_1_rad: 0.02\ncrank_latency_s: 0.003\n");
  const Checked<Settings> settings = loadShippedWith({file.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_NEAR(settings.value->pipeline.crank_sensor.reading(0.0), 0.4, 1e-15);
  EXPECT_LT(settings.value->pipeline.crank_sensor.gain(), 0.0);
  EXPECT_EQ(settings.value->pipeline.crank_latency, 0.003);
  EXPECT_TRUE(loadShippedWith({}).value->pipeline.crank_sensor.isIdentity());
}

TEST(Load, ImpossibleCrankSensorIsRefusedByItsKeys) {
  EXPECT_EQ(problemsOf("crank_direction: 0\n"), (Lines{"crank_direction: 0, must be 1 or -1 (FILE:1)"}));
  EXPECT_EQ(problemsOf("crank_ratio: 2.0\ncrank_eccentricity_1_rad: 0.02\n"),
            (Lines{"crank_ratio: 2, must be 1 with crank_eccentricity_1_rad or crank_eccentricity_2_rad (FILE:1)"}));
  EXPECT_EQ(problemsOf("crank_eccentricity_1_rad: 0.6\ncrank_eccentricity_2_rad: 0.2\n").size(), 1U);
  EXPECT_EQ(problemsOf("crank_ratio: 0.0\n").size(), 1U);
}

}  // namespace
}  // namespace hammer_loads
