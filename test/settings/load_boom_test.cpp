// A robot description with or without a boom file: when there is a boom, and one-line messages for faults.
#include "boom/booms.h"
#include "settings/hammer_yaml.h"
#include "settings/load_support.h"

namespace hammer_loads {
namespace {

using test::hammerYaml;
using test::Lines;
using test::loadShippedWith;
using test::TemporaryFile;
using test::withFirstReplaced;

class LoadBoom : public testing::Test {
 protected:
  /// Loads a description and a boom file's content, followed by `more`.
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
  const std::string urdf_ = test::shippedUrdf();
  const std::string boom_ = test::textOf(configDirectory() + "/boom_eo2621.yaml");
  const std::string rigid_ = "boom: rigid\n";
};

TEST_F(LoadBoom, ReadsTheShippedDescriptionAndFile) {
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

TEST_F(LoadBoom, GivesARigidBoomFromTheDescriptionAlone) {
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
  const std::string other = withFirstReplaced(urdf_, "<link name=\"hammer_hull\"", "<link name=\"bucket\"");
  const std::string foreign = "<robot name=\"other\"><link name=\"base_link\"/></robot>";
  for (const std::string& more : {std::string("boom: auto\n"), std::string("stale_after_s: 0.3\n")}) {
    const Checked<Settings> settings = loaded(foreign, more);
    ASSERT_EQ(settings.problems, Lines{});
    EXPECT_FALSE(settings.value->boom);
    EXPECT_EQ(settings.value->notes,
              Lines{"robot_description: has no link hammer_hull: no boom, the hammer's loads on its hull alone"});
  }
  // A boom file or a model that needs the description is meant for this description.
  expectOne(loaded(foreign, boom_), "robot_description: link hammer_hull: not in the model");
  expectOne(loaded(foreign, rigid_), "robot_description: link hammer_hull: not in the model");
  // An unreadable description is not regarded as one of another machine.
  expectOne(loaded(other, "boom: auto\n"), "robot_description: cannot be read: ");
}

TEST_F(LoadBoom, DifferencesOfVelocitiesAreForARigidBoom) {
  const std::string difference = "boom_acceleration: difference\n";
  EXPECT_EQ(loaded(urdf_, boom_, difference + "boom: rigid").problems, Lines{});
  for (const char* model : {"boom: compliant", "boom: auto"})
    expectOne(loaded(urdf_, boom_, difference + model), "boom_acceleration: difference, must be none with a boom");
  EXPECT_EQ(loaded(urdf_, boom_, "boom_stiffness: identified\nboom: compliant").problems, Lines{});
}

TEST_F(LoadBoom, GivesNoneForBoomNone) {
  EXPECT_FALSE(loaded(urdf_, boom_, "boom: none").value.value().boom);
  EXPECT_FALSE(loaded("", boom_, "boom: none").value.value().boom);
  EXPECT_FALSE(loaded("no URDF", "boom: none").value.value().boom);
  // Its keys are still checked.
  expectOne(loaded("", withFirstReplaced(boom_, "bore_m: 0.110", "bore_m: wide"), "boom: none"),
            "boom_cylinder_bore_m: wide m, must");
}

TEST_F(LoadBoom, RefusesAFileOrAModelWithoutDescription) {
  expectOne(loaded("", boom_), "robot_description: missing, must be given (a URDF) with a boom file");
  expectOne(loaded("", rigid_), "robot_description: missing, must be given (a URDF)");
  expectOne(loaded("", "boom: compliant\n"), "robot_description: missing, must be given (a URDF)");
}

TEST_F(LoadBoom, AcceptsItsLoadsAsCountedChannels) {
  const std::string arm = "hull_x_channel: joint_loads/arm_joint/total_torque\n";
  EXPECT_EQ(loaded(urdf_, boom_, arm).problems, Lines{});
  EXPECT_EQ(loaded(urdf_, boom_, "hull_x_channel: joint_loads/arm_cylinder/force\n").problems, Lines{});
  EXPECT_EQ(loaded("", "", arm).problems.size(), 1U);
}

TEST_F(LoadBoom, AMachineIsItsHammerAndItsBoom) {
  const std::string machine = loaded(urdf_, boom_).value->machine;
  EXPECT_EQ(loaded(urdf_, boom_, "crank_zero_rad: 0.1\nlife_classes: 64\n").value->machine, machine);
  EXPECT_NE(loaded(urdf_, withFirstReplaced(boom_, "damping_ratio: 0.05", "damping_ratio: 0.06")).value->machine,
            machine);
  EXPECT_NE(loaded(urdf_ + "<!-- -->", boom_).value->machine, machine);
  const auto of = [](const char* key, const char* value) {
    return loadShippedWith({TemporaryFile(hammerYaml({{key, value}})).path()}).value->machine;
  };
  EXPECT_EQ(of("drive_inertia_kg_m2", "1.5"), of("drive_inertia_kg_m2", "2.5"));
  EXPECT_NE(of("rocker_mass_kg", "36.5"), of("rocker_mass_kg", "37.5"));
}

}  // namespace
}  // namespace hammer_loads
