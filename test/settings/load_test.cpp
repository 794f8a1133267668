// Shipped and given parameter files together: which value applies, what is kept, which files are refused.
#include <algorithm>
#include <filesystem>

#include "settings/hammer_yaml.h"
#include "settings/load_support.h"

namespace hammer_loads {
namespace {

using test::hammerYaml;
using test::Lines;
using test::loadShippedWith;
using test::problemsOf;
using test::TemporaryFile;

TEST(Load, ShippedFilesOfOneKindEachLoadOverThemselves) {
  for (const char* name : {"hammer_mo100.yaml", "pipeline.yaml", "log.yaml", "life.yaml"}) {
    const Checked<Settings> settings = loadShippedWith({configDirectory() + "/" + name});
    ASSERT_EQ(settings.problems, Lines{}) << name;
    EXPECT_EQ(settings.value->yaml, loadShippedWith({}).value->yaml) << name;
  }
}

TEST(Load, LaterFilesReplaceEarlierOnes) {
  const TemporaryFile first("gravity_m_s2: 1.0\nstale_after_s: 0.5\n"), second("gravity_m_s2: 2.0\n");
  const Checked<Settings> settings = loadShippedWith({first.path(), second.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_EQ(settings.value->pipeline.gravity, 2.0);
  EXPECT_EQ(settings.value->pipeline.stale_after, 0.5);
  EXPECT_EQ(loadShippedWith({second.path(), first.path()}).value->pipeline.gravity, 1.0);
}

TEST(Load, DumpIsStableAndReloadsToTheSame) {
  const TemporaryFile changes(
      "gravity_m_s2: 9.8123456789012345\nlog_directory: \"C:\\\\a \\\"b\\\"\"\npitch_joints: []\n");
  const Checked<Settings> settings = loadShippedWith({changes.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_EQ(loadShippedWith({changes.path()}).value->yaml, settings.value->yaml);
  const TemporaryFile dump(settings.value->yaml);
  const Checked<Settings> reloaded = loadShippedWith({dump.path()});
  ASSERT_EQ(reloaded.problems, Lines{});
  EXPECT_EQ(reloaded.value->yaml, settings.value->yaml);
  EXPECT_EQ(reloaded.value->pipeline.gravity, settings.value->pipeline.gravity);
  EXPECT_EQ(reloaded.value->log.directory, "C:\\a \"b\"");
  EXPECT_EQ(reloaded.value->pipeline.pitch_joints, Lines{});
  EXPECT_EQ(reloaded.value->mechanism.parameters().rocker_com_angle,
            settings.value->mechanism.parameters().rocker_com_angle);
}

TEST(Load, DumpHoldsEveryShippedKeyOnce) {
  const std::string yaml = loadShippedWith({}).value->yaml;
  std::vector<std::string> problems;
  const ParameterMap dumped = parameterMap(YAML::Load(yaml), "dump", problems).value();
  EXPECT_EQ(problems, Lines{});
  std::size_t shipped = 0;
  for (const char* name : {"/hammer_mo100.yaml", "/pipeline.yaml", "/log.yaml", "/life.yaml"})
    shipped += readParameterFile(configDirectory() + name, problems)->size();
  EXPECT_EQ(dumped.size(), shipped);
}

TEST(Load, GivenChannelsReplaceTheShippedOnes) {
  const std::string arm =
      "life_channels: [hull_z, arm]\narm_channel: hull_wrench/force_x\narm_full_scale_least: -1\n"
      "arm_full_scale_greatest: 1\n";
  const TemporaryFile file(arm);
  const Checked<Settings> settings = loadShippedWith({file.path()});
  ASSERT_EQ(settings.problems, Lines{});
  ASSERT_EQ(settings.value->life.channels.size(), 2U);
  EXPECT_EQ(settings.value->life.channels[0].name, "hull_wrench/force_z");
  EXPECT_EQ(settings.value->life.channels[1].key, "arm");
  EXPECT_EQ(settings.value->yaml.find("hull_x"), std::string::npos);
  const TemporaryFile dump(settings.value->yaml);
  EXPECT_EQ(loadShippedWith({dump.path()}).value->yaml, settings.value->yaml);
  EXPECT_EQ(problemsOf(arm + "hull_x_full_scale_least: -1\n").size(), 1U) << "given for no channel";
}

TEST(Load, CountedChannelsMustBeLoadsOfTheMachine) {
  EXPECT_EQ(problemsOf("hull_x_channel: joint_loads/arm_joint/total_torque\n"),
            Lines{"hull_x_channel: \"joint_loads/arm_joint/total_torque\", must be a load of this machine: "
                  "hull_wrench/force_x, hull_wrench/force_z, hull_wrench/torque_y (FILE:1)"});
}

TEST(Load, RefusesWhatIsNoYamlMap) {
  EXPECT_EQ(problemsOf("- a\n- b\n"), Lines{"FILE: (a list), must be a map of keys to values"});
  EXPECT_EQ(problemsOf("word"), Lines{"FILE: word, must be a map of keys to values"});
  EXPECT_EQ(problemsOf("a: 1\n---\nb: 2\n"), Lines{"FILE: 2 YAML documents, must be one"});
  const Lines broken = problemsOf("a: 1\nb: [1, 2\n");
  ASSERT_EQ(broken.size(), 1U);
  EXPECT_EQ(broken[0].rfind("FILE:", 0), 0U) << broken[0];
  EXPECT_NE(broken[0].find("not valid YAML: "), std::string::npos) << broken[0];
  for (const std::string& empty : {std::string{}, std::string("# only a comment\n")}) {
    const Lines problems = problemsOf(empty);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].rfind("FILE: ", 0), 0U) << problems[0];
  }
}

TEST(Load, RefusesRepeatedAndNamelessKeys) {
  EXPECT_EQ(problemsOf("gravity_m_s2: 9.8\nstale_after_s: 1\ngravity_m_s2: 9.9\n"),
            Lines{"gravity_m_s2: given twice, must be given once (FILE:1, FILE:3)"});
  EXPECT_EQ(problemsOf("? [a]\n: 1\n"), Lines{"FILE:1: (a list) as a key, must be a text"});
}

TEST(Load, RefusesUnreadableFilesAndNamesEach) {
  const std::string missing = testing::TempDir() + "no_such_file.yaml";
  EXPECT_EQ(loadShippedWith({missing, testing::TempDir()}).problems,
            (Lines{missing + ": cannot be read: No such file or directory",
                   testing::TempDir() + ": is a directory, must be a file of parameters"}));
  const std::string longest(4095, 'x');  // a legal path that the message must contain
  EXPECT_EQ(loadShippedWith({longest}).problems.at(0).rfind(longest + ": cannot be read: ", 0), 0U);
  const Lines no_config = loadFiles(testing::TempDir() + "nowhere", {}).problems;
  ASSERT_EQ(no_config.size(), 4U);
  EXPECT_NE(no_config[0].find("nowhere/pipeline.yaml: cannot be read"), std::string::npos) << no_config[0];
}

TEST(Load, AFileTooLongForParametersIsNotParsed) {
  const std::string good = "gravity_m_s2: 9.8\n";
  EXPECT_EQ(problemsOf(good + std::string(900000, '#')), Lines{});
  const Lines problems = problemsOf(good + std::string(1100000, '#'));
  EXPECT_EQ(problems, Lines{"FILE: more than 1000000 bytes, must be a file of parameters"});
  EXPECT_EQ(loadShippedWith({"/dev/zero"}).problems,
            Lines{"/dev/zero: more than 1000000 bytes, must be a file of parameters"});
}

}  // namespace
}  // namespace hammer_loads
