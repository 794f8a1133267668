#include "hammer_loads/linkage/hammer_constants.h"
#include "hammer_loads/settings/readers.h"
#include "settings/hammer_yaml.h"
#include "settings/load_support.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::hammerYaml;
using test::Lines;
using test::TemporaryFile;

Lines problemsWith(const std::map<std::string, std::string>& altered, const std::string& added = {}) {
  return test::problemsOf(hammerYaml(altered) + added);
}

/// Loads the shipped hammer file and the added keys.
Checked<Settings> loadedWith(const std::string& added) {
  const TemporaryFile file(hammerYaml() + added);
  return loadFiles(configDirectory(), {file.path()});
}

HammerParameters parametersWith(const std::string& added) { return loadedWith(added).value->mechanism.parameters(); }

bool beginsWith(const std::string& text, const std::string& beginning) { return text.rfind(beginning, 0) == 0; }

class EveryHammerKey : public testing::TestWithParam<std::string> {};

TEST_P(EveryHammerKey, MustHaveItsSign) {
  const bool any_sign = GetParam().find("_com_a") != std::string::npos;  // angle, along, across
  const Lines problems = problemsWith({{GetParam(), "-0.003"}});
  if (any_sign) {
    EXPECT_EQ(problems, Lines{});
  } else {
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_TRUE(beginsWith(problems[0], GetParam() + ": -0.003")) << problems[0];
    EXPECT_NE(problems[0].find(", must be >"), std::string::npos) << problems[0];
  }
}

/// Returns a standard deviation for each constant, small enough for any hammer.
std::string allDeviations() {
  std::string text;
  for (const HammerConstant& constant : kHammerConstants) text += deviationKey(constant) + ": 1e-5\n";
  return text;
}

TEST_P(EveryHammerKey, IsAloneAccusedBesideRightDeviations) {
  EXPECT_EQ(problemsWith({}, allDeviations()), Lines{});
  for (const char* wrong : {"", "word", ".nan"}) {
    const Lines problems = problemsWith({{GetParam(), wrong}}, allDeviations());
    ASSERT_EQ(problems.size(), 1U) << wrong << ": " << problems[1];
    EXPECT_TRUE(beginsWith(problems[0], GetParam() + ": ")) << problems[0];
  }
  // An implausible value may violate a rule between two keys.
  for (const std::string& problem : problemsWith({{GetParam(), "1e9"}}, allDeviations()))
    EXPECT_EQ(problem.find("_std"), std::string::npos) << problem;
}

INSTANTIATE_TEST_SUITE_P(Hammer, EveryHammerKey, testing::ValuesIn(hammerKeys()),
                         [](const testing::TestParamInfo<std::string>& key) { return key.param; });

TEST(HammerParameters, StrikingOffsetAndFrictionAreOptional) {
  const HammerParameters absent = parametersWith("");
  EXPECT_EQ(absent.striking_offset, 0.0);
  EXPECT_EQ(absent.striking_friction, 0.0);
  const HammerParameters given =
      parametersWith("striking_offset_m: -0.012\nstriking_friction: 0.2\nstriking_offset_std_m: 0.0005\n");
  EXPECT_EQ(given.striking_offset, -0.012);
  EXPECT_EQ(given.striking_friction, 0.2);
  EXPECT_EQ(given.deviations[*indexOfConstant("striking_offset_m")], 5e-4);
  for (const char* wrong : {"word", ".nan", "~", "20.0"})
    EXPECT_EQ(problemsWith({}, std::string("striking_offset_m: ") + wrong + "\n").size(), 1U) << wrong;
  for (const char* wrong : {"-0.1", "word", "3.0"})
    EXPECT_EQ(problemsWith({}, std::string("striking_friction: ") + wrong + "\n").size(), 1U) << wrong;
  const Lines jammed = problemsWith({}, "striking_offset_m: 0.2\nstriking_friction: 1.5\n");
  ASSERT_EQ(jammed.size(), 1U);
  EXPECT_TRUE(beginsWith(jammed[0], "striking_offset_m: 0.2 m, times striking_friction")) << jammed[0];
}

TEST(HammerParameters, DeviationsNotGivenAreTheUsualOnesWithANote) {
  const Checked<Settings> usual = loadedWith(""), given = loadedWith("rocker_mass_std_kg: 0.0\n");
  ASSERT_TRUE(usual.value && given.value);
  constexpr std::size_t kLength = 0, kMass = 6;  // in the file's order
  const HammerParameters& read = usual.value->mechanism.parameters();
  EXPECT_EQ(read.deviations[kLength], 3e-4);
  EXPECT_EQ(read.deviations[kMass], 0.02 * read.rocker_mass);
  EXPECT_NE(usual.notes[0].find("rocker_mass_std_kg"), std::string::npos);
  EXPECT_EQ(given.value->mechanism.parameters().deviations[kMass], 0.0);
  EXPECT_EQ(given.notes[0].find("rocker_mass_std_kg"), std::string::npos);
  const Lines problems = problemsWith({}, "rocker_mass_std_kg: 50.0\n");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(beginsWith(problems[0], "rocker_mass_std_kg: 50 kg, no hammer")) << problems[0];
}

TEST(HammerParameters, TheDrivesReactionCountsAsOneWithANote) {
  const Checked<Settings> absent = loadedWith(""), given = loadedWith("drive_reaction_ratio: -0.2\n");
  ASSERT_TRUE(absent.value && given.value);
  EXPECT_EQ(absent.value->mechanism.parameters().drive_reaction_ratio, 1.0);
  ASSERT_EQ(absent.notes.size(), 2U);
  EXPECT_TRUE(beginsWith(absent.notes[1], "drive_reaction_ratio: not given, counts as 1")) << absent.notes[1];
  EXPECT_EQ(given.value->mechanism.parameters().drive_reaction_ratio, -0.2);
  EXPECT_EQ(given.notes.size(), 1U);  // about the deviations
  EXPECT_EQ(problemsWith({}, "drive_reaction_ratio: 1e9\n").size(), 1U);
}

TEST(HammerParameters, TheRodsSpringIsOptional) {
  const Checked<Settings> given = loadedWith(
      "rod_stiffness_N_m: 1e9\nrod_damping_ratio: 0.3\npin_play_m: 0.0002\npin_friction_radius_m: 0.0005\n"
      "level: elastic\n");
  ASSERT_TRUE(given.value);
  EXPECT_EQ(parametersWith("").rod.stiffness, 0.0);
  const RodSpring& rod = given.value->mechanism.parameters().rod;
  EXPECT_EQ(rod.stiffness, 1e9);
  EXPECT_EQ(rod.damping_ratio, 0.3);
  EXPECT_EQ(rod.play, 2e-4);
  EXPECT_EQ(rod.friction_radius, 5e-4);
  EXPECT_EQ(given.value->pipeline.level, Level::kElastic);
  EXPECT_STREQ(nameOf(given.value->pipeline.level), "elastic");
  EXPECT_EQ(problemsWith({},
                         "rod_stiffness_N_m: 10\nrod_damping_ratio: -1\npin_play_m: 0.1\n"
                         "pin_friction_radius_m: 0.1\n")
                .size(),
            4U);
}

TEST(HammerParameters, TakesTheRodAsUncertainUnlessTheFileStatesIt) {
  const HammerParameters usual = parametersWith("");
  EXPECT_TRUE(priorOf(usual.rod, usual.rod_std).is_elastic);
  const HammerParameters weighed =
      parametersWith("rod_stiffness_std_N_m: 1e8\nrod_damping_ratio_std: 0.1\npin_play_std_m: 5e-5\n");
  EXPECT_EQ(weighed.rod_std.stiffness, 1e8);
  EXPECT_EQ(weighed.rod_std.damping_ratio, 0.1);
  EXPECT_EQ(weighed.rod_std.play, 5e-5);
  EXPECT_EQ(parametersWith("pin_friction_radius_std_m: 2e-4\n").rod_std.friction_radius, 2e-4);
  const HammerParameters rigid = parametersWith("rod_stiffness_std_N_m: 0\npin_play_std_m: 0\n");
  EXPECT_FALSE(priorOf(rigid.rod, rigid.rod_std).is_elastic);
  EXPECT_EQ(problemsWith({}, "rod_stiffness_std_N_m: -1\n").size(), 1U);
}

TEST(HammerParameters, RefusesAnImpossibleLinkageWithItsNumbers) {
  const Lines problems = problemsWith({{"rod_length_m", "0.151"}});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(beginsWith(problems[0], "rod_length_m: impossible linkage: ")) << problems[0];
  EXPECT_NE(problems[0].find("0.048 + 0.151 - 0.078 - 0.12"), std::string::npos) << problems[0];
}

TEST(HammerParameters, AcceptsASmallMissOfTheChangePointAndNotesIt) {
  const TemporaryFile file(hammerYaml({{"rod_length_m", "0.15004"}}));
  const Checked<Settings> settings = loadFiles(configDirectory(), {file.path()});
  ASSERT_EQ(settings.problems, Lines{});
  EXPECT_NEAR(settings.value->mechanism.parameters().lengths.rod, 0.150, 1e-15);
  ASSERT_FALSE(settings.notes.empty());
  EXPECT_TRUE(beginsWith(settings.notes[0], "rod_length_m: 0.15004 m corrected")) << settings.notes[0];
  EXPECT_NE(settings.value->yaml.find("rod_length_m: 0.15004\n"), std::string::npos);
}

TEST(HammerParameters, RefusesAnInertiaAboutTheWrongPoint) {
  const Lines problems = problemsWith({{"rocker_inertia_about_pivot_kg_m2", "0.3415"}});  // P0's about S
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].find("about the pivot D"), std::string::npos) << problems[0];
}

TEST(HammerParameters, ReportsSeveralProblemsTogetherOneLineEach) {
  const Lines problems = problemsWith(
      {{"crank_length_m", ""}, {"rod_length_m", "-0.15"}, {"rocker_mass_kg", "heavy"}, {"rod_mass_kg", "-1"}},
      "rocker_mas_kg: 35.2\nlevel: 3\nlog_split_mb: 0\n");
  ASSERT_EQ(problems.size(), 7U);
  const Lines beginnings{"crank_length_m: missing",
                         "rocker_mass_kg: heavy kg, must be a finite number",
                         "rod_length_m: -0.15 m, must be > 0",
                         "rod_mass_kg: -1 kg, must be >= 0",
                         "level: 3, must be one of pulse, rocker, linkage",
                         "log_split_mb: 0 MB, must be an integer in [1, ",
                         "rocker_mas_kg: unknown key, perhaps rocker_mass_kg was meant"};
  for (std::size_t i = 0; i < beginnings.size(); ++i)
    EXPECT_TRUE(beginsWith(problems[i], beginnings[i])) << problems[i];
}

}  // namespace
}  // namespace hammer_loads
