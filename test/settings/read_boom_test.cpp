#include "hammer_loads/settings/read_boom.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "boom/booms.h"
#include "hammer_loads/settings/parameter_reader.h"

namespace hammer_loads {
namespace {

class BoomFile : public testing::Test {
 protected:
  BoomFile()
      : urdf_(test::shippedUrdf()),
        yaml_(test::textOf(test::sourceFile("config/boom_eo2621.yaml"))),
        file_(std::filesystem::temp_directory_path() / format("boom_%d.yaml", getpid())) {}
  ~BoomFile() override { std::filesystem::remove(file_); }

  /// The shipped file with a piece of it replaced.
  std::vector<std::string> problems(const std::string& piece, const std::string& by) {
    std::string text = yaml_;
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    text.replace(at, piece.size(), by);
    std::ofstream(file_) << text;
    const Checked<Boom> made = loadBoom(urdf_, {file_.string()});
    EXPECT_EQ(made.value.has_value(), made.problems.empty());
    return made.problems;
  }
  void expectOne(const std::string& piece, const std::string& by, const std::string& begins) {
    const std::vector<std::string> found = problems(piece, by);
    ASSERT_EQ(found.size(), 1U) << piece << (found.empty() ? "" : ": " + found.back());
    EXPECT_EQ(found[0].rfind(begins, 0), 0U) << found[0];
    EXPECT_EQ(found[0].find('\n'), std::string::npos);
  }

  std::string urdf_, yaml_;
  std::filesystem::path file_;
};

TEST_F(BoomFile, ShippedOneLoads) {
  EXPECT_TRUE(problems("damping_ratio", "damping_ratio").empty());
  const Boom boom = test::shippedBoom();
  EXPECT_EQ(boom.chain().jointNames(),
            (std::vector<std::string>{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"}));
  EXPECT_EQ(boom.cylinders().size(), 3U);
}

TEST_F(BoomFile, EachFaultIsOneLine) {
  expectOne("damping_ratio: 0.05", "damping_ratio: 1.5", "damping_ratio: 1.5, must be > 0 and < 1");
  expectOne("damping_ratio: 0.05", "damping_ratio: lots", "damping_ratio: ");
  expectOne("bulk_modulus_Pa: 1.0e+9", "bulk_modulus_Pa: -1.0", "bulk_modulus_Pa: -1 Pa, must be a finite number > 0");
  expectOne("arm_cylinder_bore_m: 0.100", "arm_cylinder_bore_m: 0.0",
            "arm_cylinder_bore_m: 0 m, must be a finite number > 0");
  expectOne("arm_cylinder_joint: arm_joint", "arm_cylinder_joint: elbow",
            "arm_cylinder_joint: elbow, must be a revolute");
  expectOne("arm_cylinder_joint: arm_joint", "arm_cylinder_joint: boom_joint", "arm_cylinder_");
  expectOne("arm_cylinder_stroke_m: 0.73", "arm_cylinder_stroke_m: 0.5",
            "arm_cylinder_closed_length_m: 1 m, cannot close");
  expectOne("tip_link: hammer_hull", "tip_link: hull", "robot_description: link hull: not in the model");
  expectOne("support_front_x_m: -0.10", "support_front_x_m: -5.0",
            "support_front_x_m: -5 m, must be > support_rear_x_m");
  expectOne("rigid_tolerance: 0.05", "rigid_tolerance: 0.0", "rigid_tolerance: 0, must be");
}

TEST_F(BoomFile, UnknownAndMissingKeysAreTold) {
  expectOne("rigid_tolerance:", "spare_key: 1.0\nrigid_tolerance:", "spare_key: ");
  EXPECT_EQ(problems("damping_ratio: 0.05", "damping: 0.05").size(), 2U);  // one missing, one unknown
  const std::vector<std::string> found = problems("cylinders: [boom_cylinder,", "cylinders: [bom_cylinder,");
  EXPECT_GT(found.size(), 12U);  // keys of the one missing, and those of the other unknown
}

TEST_F(BoomFile, FaultsOfFileAndDescriptionComeTogether) {
  const std::size_t mass = urdf_.find("<mass value=\"400\"/>");
  urdf_.replace(mass, 19, "<mass value=\"-40\"/>");
  const std::vector<std::string> found = problems("damping_ratio: 0.05", "damping_ratio: -0.05");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].rfind("damping_ratio", 0), 0U);
  EXPECT_EQ(found[1].rfind("robot_description: mass of link boom_link: -40 kg", 0), 0U) << found[1];
}

TEST_F(BoomFile, TwoCylindersCannotShareAJoint) {
  BoomParameters parameters = test::shippedBoomParameters();
  parameters.cylinders.push_back(parameters.cylinders[0]);
  parameters.cylinders.back().name = "second";
  const Checked<Boom> made = Boom::make(urdf_, parameters);
  ASSERT_EQ(made.problems.size(), 1U);
  EXPECT_EQ(made.problems[0], "second_joint: boom_joint, has a cylinder already, must have at most one");
}

TEST_F(BoomFile, WithoutCylindersTheBoomIsRigid) {
  BoomParameters parameters = test::shippedBoomParameters();
  parameters.cylinders.clear();
  Checked<Boom> made = Boom::make(urdf_, parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  const JointVector zero = JointVector::Zero(4);
  made.value->moveCompliant({zero, zero, zero}, Eigen::Vector3d::Zero());
  EXPECT_FALSE(made.value->vibration().known());
  EXPECT_FALSE(made.value->vibration().modes().dead_point);
  made.value->vibration().advance(0.1, {zero, zero, zero});
  EXPECT_TRUE(made.value->vibration().torque().isZero(0.0));
}

}  // namespace
}  // namespace hammer_loads
