#include "hammer_loads/settings/load.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "settings/hammer_yaml.h"
#include "settings/temporary_file.h"

namespace hammer_loads {
namespace {

using Lines = std::vector<std::string>;
using test::hammerYaml;
using test::TemporaryFile;

Checked<Settings> loadShippedWith(const std::vector<std::string>& files) { return loadFiles(configDirectory(), files); }

Lines problemsOf(const std::string& content) {
  const TemporaryFile file(content);
  const Checked<Settings> settings = loadShippedWith({file.path()});
  EXPECT_EQ(settings.value.has_value(), settings.problems.empty());
  Lines problems = settings.problems;
  for (std::string& line : problems) {
    for (std::size_t place = 0; (place = line.find(file.path())) != std::string::npos;)
      line.replace(place, file.path().size(), "FILE");
  }
  return problems;
}

TEST(Load, ShippedFilesAreValid) {
  const Checked<Settings> settings = loadShippedWith({});
  ASSERT_EQ(settings.problems, Lines{});
  const PipelineSettings& p = settings.value->pipeline;
  EXPECT_EQ(p.level, Level::kLinkage);
  EXPECT_EQ(p.crank_joint, "hammer_crank_joint");
  EXPECT_EQ(p.pitch_joints, (Lines{"boom_joint", "arm_joint", "hammer_joint"}));
  EXPECT_EQ(p.gravity, 9.80665);
  EXPECT_EQ(p.crank_angle_resolution, 0.0);
  EXPECT_EQ(p.stale_after, 0.25);
  EXPECT_EQ(p.withhold_above, 0.1);
  const LogSettings& log = settings.value->log;
  EXPECT_TRUE(log.enabled);
  EXPECT_FALSE(log.directory.empty());
  EXPECT_EQ(log.split_size, 512000000U);
  EXPECT_FALSE(log.prune_earlier_runs);
  EXPECT_EQ(filePrefix(forNode(log, "/left/hammer_loads")), "left_hammer_loads");
}

TEST(Load, ShippedFilesOfOneKindEachLoadOverThemselves) {
  for (const char* name : {"hammer_mo100.yaml", "pipeline.yaml", "log.yaml", "life.yaml"}) {
    const Checked<Settings> settings = loadShippedWith({configDirectory() + "/" + name});
    ASSERT_EQ(settings.problems, Lines{}) << name;
    EXPECT_EQ(settings.value->yaml, loadShippedWith({}).value->yaml) << name;
  }
}

TEST(Load, GivenKeysReplaceShippedOnesKeyByKey) {
  const TemporaryFile file("gravity_m_s2: 1.62\ncrank_stamps: steady\nlog_enabled: false\n");
  const Checked<Settings> settings = loadShippedWith({file.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_EQ(settings.value->pipeline.gravity, 1.62);
  EXPECT_EQ(settings.value->pipeline.crank_stamps, CrankStamps::kSteady);
  EXPECT_FALSE(settings.value->log.enabled);
  EXPECT_EQ(settings.value->pipeline.stale_after, 0.25);
  EXPECT_EQ(settings.value->mechanism.parameters().rocker_mass, 35.2);
}

TEST(Load, LaterFilesReplaceEarlierOnes) {
  const TemporaryFile first("gravity_m_s2: 1.0\nstale_after_s: 0.5\n"), second("gravity_m_s2: 2.0\n");
  const Checked<Settings> settings = loadShippedWith({first.path(), second.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_EQ(settings.value->pipeline.gravity, 2.0);
  EXPECT_EQ(settings.value->pipeline.stale_after, 0.5);
  EXPECT_EQ(loadShippedWith({second.path(), first.path()}).value->pipeline.gravity, 1.0);
}

TEST(Load, OneHammerKeyMeansThatAllMustBeGiven) {
  const Lines problems = problemsOf("rocker_mass_kg: 40.0\n");
  EXPECT_EQ(problems.size(), hammerKeys().size() - 1);
  EXPECT_TRUE(std::all_of(problems.begin(), problems.end(), [](const std::string& line) {
    return line.find(": missing, must be") != std::string::npos;
  }));
}

TEST(Load, HammerKeysMayBeSpreadOverFiles) {
  const TemporaryFile most(hammerYaml({{"rocker_mass_kg", ""}})), rest("rocker_mass_kg: 40.0\n");
  const Checked<Settings> settings = loadShippedWith({most.path(), rest.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_EQ(settings.value->mechanism.parameters().rocker_mass, 40.0);
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
      "life_channels: [hull_z, arm]\narm_channel: hull_wrench/force_x_N\narm_full_scale_least: -1\n"
      "arm_full_scale_greatest: 1\n";
  const TemporaryFile file(arm);
  const Checked<Settings> settings = loadShippedWith({file.path()});
  ASSERT_EQ(settings.problems, Lines{});
  ASSERT_EQ(settings.value->life.channels.size(), 2U);
  EXPECT_EQ(settings.value->life.channels[0].name, "hull_wrench/force_z_N");
  EXPECT_EQ(settings.value->life.channels[1].key, "arm");
  EXPECT_EQ(settings.value->yaml.find("hull_x"), std::string::npos);
  const TemporaryFile dump(settings.value->yaml);
  EXPECT_EQ(loadShippedWith({dump.path()}).value->yaml, settings.value->yaml);
  EXPECT_EQ(problemsOf(arm + "hull_x_full_scale_least: -1\n").size(), 1U) << "given for no channel";
}

TEST(Load, CountedChannelsMustBeLoadsOfTheMachine) {
  EXPECT_EQ(problemsOf("hull_x_channel: joint_loads/arm_joint/total_torque_Nm\n"),
            Lines{"hull_x_channel: \"joint_loads/arm_joint/total_torque_Nm\", must be a load of this machine: "
                  "hull_wrench/force_x_N, hull_wrench/force_z_N, hull_wrench/torque_y_Nm (FILE:1)"});
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
                   testing::TempDir() + ": is a directory, must be a YAML file"}));
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

struct BadPair {
  const char* good;
  const char* bad;
  const char* problem;
};

TEST(Load, PipelineAndLogKeysGoodAndBadInPairs) {
  const BadPair pairs[] = {
      {"level: linkage", "level: Linkage", "level: Linkage, must be one of pulse, rocker, linkage, elastic, auto"},
      {"level: auto", "tolerance: 0", "tolerance: 0, must be a number in [1.0e-09, 10.0]"},
      {"hull_motion: imu", "hull_motion: model",
       "hull_motion: model, must be fixed or imu without a boom file: its cylinders' oil is the spring"},
      {"output: mean", "output: median", "output: median, must be one of instantaneous, mean"},
      {"output_rate_Hz: 50", "output_rate_Hz: -1", "output_rate_Hz: -1 Hz, must be 0 or a number in [0.001, 100000.0]"},
      {"output_rate_Hz: 0.001", "output_rate_Hz: 1e-12",
       "output_rate_Hz: 1e-12 Hz, must be 0 or a number in [0.001, 100000.0]"},
      {"output_rate_Hz: 1e5", "output_rate_Hz: 1e5\nstale_after_s: 9",
       "output_rate_Hz: 100000 Hz, must be at most 100000 outputs over stale_after_s = 9 s"},
      {"torque_deviation_part: 1", "torque_deviation_part: 2",
       "torque_deviation_part: 2, must be a number in [0.0, 1.0]"},
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
      {"boom_wrench_links: []", "boom_wrench_links: [/arm_link]",
       "boom_wrench_links: /arm_link, must be names of a letter first, then letters, digits, _ and /"},
      {"log_enabled: true", "log_enabled: \"true\"", "log_enabled: \"true\", must be true or false"},
      {"log_prefix: p", "log_prefix: p/q", "log_prefix: \"p/q\", must be a file name's beginning, without /"},
      {"log_prune_earlier_runs: false", "log_prune_earlier_runs: 1",
       "log_prune_earlier_runs: 1, must be true or false"},
      {"log_total_mb: 0", "log_total_mb: -1", "log_total_mb: -1 MB, must be an integer in [0, 1000000000]"},
      {"log_queue_mb: 1", "log_queue_mb: 1.5", "log_queue_mb: 1.5 MB, must be an integer in [1, 1000000000]"},
      {"stale_after_s: 1", "stale_after: 1", "stale_after: unknown key, perhaps stale_after_s was meant"}};
  for (const BadPair& pair : pairs) {
    EXPECT_EQ(problemsOf(pair.good), Lines{}) << pair.good;
    EXPECT_EQ(problemsOf(pair.bad), Lines{std::string(pair.problem) + " (FILE:1)"});
  }
}

TEST(Load, AKeyOfAnEarlierVersionIsTakenAndSaidToBeIgnored) {
  const auto loaded = [](const std::string& text) {
    const TemporaryFile file(text);
    Checked<Settings> settings = loadShippedWith({file.path()});
    EXPECT_EQ(settings.problems, Lines{}) << text;
    EXPECT_EQ(settings.value->yaml, loadShippedWith({}).value->yaml) << text;
    const std::string origin = " (" + file.path() + ":1)";
    Lines notes = settings.value->notes;
    for (std::string& note : notes) note.erase(std::min(note.find(origin), note.size()));
    return notes;
  };
  EXPECT_EQ(loaded("crank_estimator: mechanism\n"), Lines{});
  for (const std::string value : {"difference", "none", "1"})
    EXPECT_EQ(loaded("crank_estimator: " + value + "\n"),
              Lines{"crank_estimator: " + value + ", of an earlier version, is ignored: mechanism is used"});
}

TEST(Load, LevelAutoIsChosenAtStartAndTold) {
  const auto loaded = [](const std::string& text) {
    const TemporaryFile file(text);
    return *loadFiles(configDirectory(), {file.path()}).value;
  };
  const Settings strict = loaded("{level: auto, tolerance: 1.0e-6}"), loose = loaded("{level: auto, tolerance: 5.0}");
  EXPECT_EQ(strict.pipeline.level, Level::kLinkage);
  EXPECT_EQ(loose.pipeline.level, Level::kRocker);
  ASSERT_EQ(loose.notes.size(), 1U);
  EXPECT_EQ(loose.notes[0].find("level auto: rocker is the cheapest whose difference to linkage is within 5 of what"),
            0U);
  EXPECT_TRUE(loaded("{level: rocker}").notes.empty());
}

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A piece of a text replaced.
std::string with(std::string text, const std::string& piece, const std::string& by) {
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return at == std::string::npos ? text : text.replace(at, piece.size(), by);
}

class LoadBoom : public testing::Test {
 protected:
  /// Settings of a description and a boom file's content; beside it what else is given.
  static Checked<Settings> loaded(const std::string& urdf, const std::string& boom, const std::string& more = {}) {
    const TemporaryFile boom_file(boom + more + "\n");
    return loadFiles(configDirectory(), {boom_file.path()}, urdf);
  }
  static void expectOne(const Checked<Settings>& settings, const std::string& begins) {
    EXPECT_FALSE(settings.value);
    ASSERT_EQ(settings.problems.size(), 1U) << begins << (settings.problems.empty() ? "" : settings.problems.back());
    EXPECT_EQ(settings.problems[0].rfind(begins, 0), 0U) << settings.problems[0];
    EXPECT_EQ(settings.problems[0].find('\n'), std::string::npos);
  }
  const std::string urdf_ = textOf(configDirectory() + "/../urdf/eo2621_mo100.urdf");
  const std::string boom_ = textOf(configDirectory() + "/boom_eo2621.yaml");
  const std::string rigid_ = "boom: rigid\n";
};

TEST_F(LoadBoom, WithoutDescriptionAndFileThereIsNone) {
  const Checked<Settings> settings = loadShippedWith({});
  ASSERT_TRUE(settings.value);
  EXPECT_FALSE(settings.value->boom);
  EXPECT_EQ(settings.value->pipeline.boom, BoomModel::kAuto);
  EXPECT_EQ(settings.value->pipeline.boom_acceleration, BoomAcceleration::kNone);
  EXPECT_EQ(settings.value->pipeline.joint_max_age, 0.2);
  EXPECT_EQ(settings.value->pipeline.boom_wrench_links, Lines{});
  EXPECT_EQ(settings.value->pipeline.tf_max_wait, 0.5);
}

TEST_F(LoadBoom, ShippedDescriptionAndFile) {
  const Checked<Settings> settings = loaded(urdf_, boom_);
  ASSERT_EQ(settings.problems, Lines{});
  ASSERT_TRUE(settings.value->boom);
  EXPECT_EQ(settings.value->boom->cylinders().size(), 3U);
  const TemporaryFile dump(settings.value->yaml);
  const Checked<Settings> again = loadFiles(configDirectory(), {dump.path()}, urdf_);
  ASSERT_EQ(again.problems, Lines{});
  EXPECT_EQ(again.value->yaml, settings.value->yaml);
  EXPECT_EQ(again.value->boom->cylinders().size(), 3U);
}

TEST_F(LoadBoom, FromTheDescriptionAloneItIsRigid) {
  for (const std::string& given : {rigid_, std::string("boom: auto\n")}) {
    const Checked<Settings> settings = loaded(urdf_, given);
    ASSERT_EQ(settings.problems, Lines{});
    ASSERT_TRUE(settings.value->boom);
    EXPECT_TRUE(settings.value->boom->cylinders().empty());
    EXPECT_EQ(settings.value->boom->chain().joints(), 4);
  }
  expectOne(loaded(urdf_, "boom: compliant\n"), "boom: compliant, must be none, rigid or auto without a boom file");
}

TEST_F(LoadBoom, AnotherMachinesDescriptionIsANoteUnlessABoomIsAskedFor) {
  const std::string other = with(urdf_, "<link name=\"hammer_hull\"", "<link name=\"bucket\"");
  const std::string foreign = "<robot name=\"other\"><link name=\"base_link\"/></robot>";
  for (const std::string& more : {std::string("boom: auto\n"), std::string("stale_after_s: 0.3\n")}) {
    const Checked<Settings> settings = loaded(foreign, more);
    ASSERT_EQ(settings.problems, Lines{});
    EXPECT_FALSE(settings.value->boom);
    EXPECT_EQ(settings.value->notes,
              Lines{"robot_description: has no link hammer_hull: no boom, the hammer's loads on its hull alone"});
  }
  // A boom file, or a model that needs the description, is meant for it.
  expectOne(loaded(foreign, boom_), "robot_description: link hammer_hull: not in the model");
  expectOne(loaded(foreign, rigid_), "robot_description: link hammer_hull: not in the model");
  // What cannot be read is no other machine's.
  expectOne(loaded(other, "boom: auto\n"), "robot_description: cannot be read: ");
}

TEST_F(LoadBoom, DifferencesOfVelocitiesAreForARigidBoom) {
  const std::string difference = "boom_acceleration: difference\n";
  EXPECT_EQ(loaded(urdf_, boom_, difference + "boom: rigid").problems, Lines{});
  for (const char* model : {"boom: compliant", "boom: auto"})
    expectOne(loaded(urdf_, boom_, difference + model), "boom_acceleration: difference, must be none with a boom");
  EXPECT_EQ(loaded(urdf_, boom_, "boom_stiffness: identified\nboom: compliant").problems, Lines{});
}

TEST_F(LoadBoom, NoneIsNone) {
  EXPECT_FALSE(loaded(urdf_, boom_, "boom: none").value.value().boom);
  EXPECT_FALSE(loaded("", boom_, "boom: none").value.value().boom);
  EXPECT_FALSE(loaded("no URDF", "boom: none").value.value().boom);
  // Its keys are still judged.
  expectOne(loaded("", with(boom_, "bore_m: 0.110", "bore_m: wide"), "boom: none"),
            "boom_cylinder_bore_m: wide m, must");
}

TEST_F(LoadBoom, AFileOrAModelWithoutDescription) {
  expectOne(loaded("", boom_), "robot_description: missing, must be given (a URDF) with a boom file");
  expectOne(loaded("", rigid_), "robot_description: missing, must be given (a URDF)");
  expectOne(loaded("", "boom: compliant\n"), "robot_description: missing, must be given (a URDF)");
}

TEST_F(LoadBoom, EachFaultIsOneLine) {
  expectOne(loaded("no URDF", boom_), "robot_description: ");
  expectOne(loaded(with(urdf_, "</robot>", ""), boom_), "robot_description: ");
  expectOne(loaded(urdf_, with(boom_, "tip_link: hammer_hull", "tip_link: hammer")),
            "robot_description: link hammer: not in the model");
  expectOne(loaded(urdf_, with(boom_, "root_link: base_link", "root_link: hammer_tool")),
            "robot_description: link hammer_hull: hangs on");
  expectOne(loaded(with(urdf_, "<mass value=\"230\"/>", "<mass value=\"-230\"/>"), boom_),
            "robot_description: mass of link arm_link: -230 kg");
  expectOne(loaded(urdf_, with(boom_, "arm_cylinder_joint: arm_joint", "arm_cylinder_joint: elbow")),
            "arm_cylinder_joint: elbow, must be a revolute joint of the chain");
  expectOne(loaded(urdf_, with(boom_, "arm_cylinder_stroke_m: 0.73", "arm_cylinder_stroke_m: 0.5")),
            "arm_cylinder_closed_length_m: 1 m, cannot close the triangle");
  expectOne(loaded(urdf_, with(boom_, "damping_ratio: 0.05", "dampening_ratio: 0.05") + "damping_ratio: 0.05"),
            "dampening_ratio: unknown key, perhaps damping_ratio was meant");
}

TEST_F(LoadBoom, FaultsOfOneDescriptionComeTogether) {
  std::string urdf = with(urdf_, "<mass value=\"230\"/>", "<mass value=\"-230\"/>");
  urdf = with(urdf, "<mass value=\"400\"/>", "<mass value=\"-400\"/>");
  EXPECT_EQ(loaded(urdf, boom_, "stale_after_s: -1").problems.size(), 3U);
}

TEST_F(LoadBoom, ItsLoadsMayBeCounted) {
  const std::string arm = "hull_x_channel: joint_loads/arm_joint/total_torque_Nm\n";
  EXPECT_EQ(loaded(urdf_, boom_, arm).problems, Lines{});
  EXPECT_EQ(loaded(urdf_, boom_, "hull_x_channel: joint_loads/arm_cylinder/cylinder_force_N\n").problems, Lines{});
  EXPECT_EQ(loaded("", "", arm).problems.size(), 1U);
}

TEST_F(LoadBoom, AMachineIsItsHammerAndItsBoom) {
  const std::string machine = loaded(urdf_, boom_).value->machine;
  EXPECT_EQ(loaded(urdf_, boom_, "crank_zero_rad: 0.1\nlife_classes: 64\n").value->machine, machine);
  EXPECT_NE(loaded(urdf_, with(boom_, "damping_ratio: 0.05", "damping_ratio: 0.06")).value->machine, machine);
  EXPECT_NE(loaded(urdf_ + "<!-- -->", boom_).value->machine, machine);
  const auto of = [](const char* key, const char* value) {
    return loadShippedWith({TemporaryFile(hammerYaml({{key, value}})).path()}).value->machine;
  };
  EXPECT_EQ(of("drive_inertia_kg_m2", "1.5"), of("drive_inertia_kg_m2", "2.5"));
  EXPECT_NE(of("rocker_mass_kg", "36.5"), of("rocker_mass_kg", "37.5"));
}

TEST(Load, ConfigDirectoryHoldsTheShippedFiles) {
  for (const char* name : {"hammer_mo100.yaml", "pipeline.yaml", "log.yaml", "life.yaml"})
    EXPECT_TRUE(std::filesystem::is_regular_file(configDirectory() + "/" + name)) << name;
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

TEST(Load, AFlexibleShaftIsRead) {
  EXPECT_FALSE(loadShippedWith({}).value->pipeline.coupling);
  const TemporaryFile file("shaft: flexible\ncoupling_frequency_Hz: 35.0\ncoupling_motor_share: 0.4\n");
  const Checked<Settings> settings = loadShippedWith({file.path()});
  ASSERT_EQ(settings.problems, Lines{});
  ASSERT_TRUE(settings.value->pipeline.coupling);
  EXPECT_EQ(settings.value->pipeline.coupling->frequency, 35.0);
  EXPECT_EQ(settings.value->pipeline.coupling->motor_share, 0.4);
}

TEST(Load, AnAbsurdCouplingIsRefusedByItsKeys) {
  EXPECT_EQ(problemsOf("shaft: flexible\n"), Lines{});
  EXPECT_EQ(problemsOf("shaft: soft\n").size(), 1U);
  EXPECT_EQ(problemsOf("coupling_motor_share: 1.0\n"),
            (Lines{"coupling_motor_share: 1.0, must be a number in [0.05, 0.95] (FILE:1)"}));
  EXPECT_EQ(problemsOf("coupling_frequency_Hz: 0.0\n").size(), 1U);
  EXPECT_EQ(problemsOf("coupling_damping_ratio: 1.5\n").size(), 1U);
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
