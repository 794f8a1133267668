#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "boom/booms.h"
#include "hammer_loads/settings/parameter_reader.h"
#include "hammer_loads/settings/readers.h"

namespace hammer_loads {
namespace {

/// Replaces every occurrence of each pair's first text by its second.
std::string withReplaced(std::string text, const std::vector<std::pair<std::string, std::string>>& pairs) {
  for (const auto& [from, to] : pairs)
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  return text;
}

class BoomFile : public testing::Test {
 protected:
  BoomFile()
      : urdf_(test::shippedUrdf()),
        yaml_(test::textOf(test::sourceFile("config/boom_eo2621.yaml"))),
        file_(std::filesystem::temp_directory_path() / format("boom_%d.yaml", getpid())) {}
  ~BoomFile() override { std::filesystem::remove(file_); }

  /// Returns the problems of the shipped file with a piece of it replaced.
  std::vector<std::string> problems(const std::string& piece, const std::string& by) {
    std::string text = yaml_;
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    text.replace(at, piece.size(), by);
    std::ofstream(file_) << text;
    const Checked<Boom> made = test::loadBoom(urdf_, {file_.string()});
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

TEST_F(BoomFile, EachFaultIsOneLine) {
  expectOne("damping_ratio: 0.05", "damping_ratio: 1.5", "damping_ratio: 1.5, must be > 0 and < 1");
  expectOne("damping_ratio: 0.05", "damping_ratio: lots", "damping_ratio: ");
  expectOne("bulk_modulus_Pa: 1.0e+9", "bulk_modulus_Pa: -1.0", "bulk_modulus_Pa: -1 Pa, must be from 1 to 1e+15 Pa");
  expectOne("arm_cylinder_bore_m: 0.100", "arm_cylinder_bore_m: 0.0",
            "arm_cylinder_bore_m: 0 m, must be from 1e-06 to 1000 m");
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

TEST_F(BoomFile, EachFaultOfASectionIsOneLine) {
  expectOne("boom_foot_section_link: boom_link", "boom_foot_section_link: bucket",
            "boom_foot_section_link: bucket, must be a link between base_link and hammer_hull");
  expectOne("boom_foot_section_link: boom_link", "boom_foot_section_link: base_link", "boom_foot_section_link: base_l");
  expectOne("boom_foot_section_x_m: 0.50", "boom_foot_section_x_m: 2.7",
            "boom_foot_section_x_m: 2.7 m, outside the link");
  expectOne("boom_foot_section_pitch_rad: 0.0", "boom_foot_section_pitch_rad: 3.1",
            "boom_foot_section_x_m: 0.5 m, outs");
  expectOne("boom_foot_section_y_m: 0.0", "boom_foot_section_y_m: 1e300", "boom_foot_section_y_m: 1e+300 m, must be");
  expectOne("boom_foot_section_mass_beyond_kg: 308.7", "boom_foot_section_mass_beyond_kg: 401",
            "boom_foot_section_mass_beyond_kg: 401 kg, must be from 0 to the mass of boom_link, 400 kg");
  expectOne("boom_foot_section_inertia_beyond_kg_m2: 114.3", "boom_foot_section_inertia_beyond_kg_m2: -1",
            "boom_foot_section_inertia_beyond_kg_m2: -1 kg m2, must be");
  expectOne("boom_foot_section_mass_beyond_kg: 308.7", "", "boom_foot_section_mass_beyond_kg: ");  // all keys or none
  expectOne("sections: [boom_foot,", "sections: [boom_foot, boom_foot,", "sections: ");
  expectOne("boom_foot_section_pitch_rad: 0.0", "", "boom_foot_section_pitch_rad: ");
}

/// A boom with identified links gives the same results as one whose description has these values.
TEST_F(BoomFile, WeighedLinksReplaceTheDescriptions) {
  const std::string arm = R"(weighed_links: [arm_link]
arm_link_mass_kg: 250.0
arm_link_com_x_m: 0.8
arm_link_com_z_m: 0.1
arm_link_inertia_kg_m2: 100.0
arm_link_moment_x_std_kg_m: 1.0
arm_link_moment_z_std_kg_m: 2.0
)";
  ASSERT_TRUE(problems("damping_ratio:", arm + "damping_ratio:").empty());
  Boom weighed = test::loadBoom(urdf_, {file_.string()}).value.value();
  std::string described = test::withFirstReplaced(urdf_, "<origin xyz=\"0.70 0 0.06\"", "<origin xyz=\"0.80 0 0.10\"");
  described = test::withFirstReplaced(described, "<mass value=\"230\"/>", "<mass value=\"250\"/>");
  const double more = 100.0 / 86.03;
  described = test::withFirstReplaced(
      described, R"(ixx="2.43" ixy="0" ixz="0" iyy="86.03" iyz="0" izz="85.45")",
      format(R"(ixx="%.17g" ixy="0" ixz="0" iyy="100" iyz="0" izz="%.17g")", 2.43 * more, 85.45 * more));
  Boom otherwise = Boom::make(described, test::shippedBoomParameters()).value.value();
  std::mt19937 random(1);
  for (int i = 0; i < 10; ++i) {
    const JointMotion motion{test::randomPosition(weighed.chain(), random), test::joints({0.3, -0.2, 0.4, 0.1}),
                             test::joints({0.5, 1.0, -2.0, 0.7})};
    weighed.move(motion, test::kLevel), otherwise.move(motion, test::kLevel);
    for (int j = 0; j < 4; ++j)
      EXPECT_NEAR(weighed.steadyTorque(j), otherwise.steadyTorque(j), 1e-9 * 5e4);  // relative to the largest
  }
  EXPECT_EQ(weighed.parameters().chain.weighed.front().moment_z_std, 2.0);

  EXPECT_EQ(problems("damping_ratio:", withReplaced(arm, {{"arm_link", "bucket"}}) + "damping_ratio:").size(), 1U);
  EXPECT_EQ(problems("damping_ratio:", withReplaced(arm, {{"250.0", "-250.0"}}) + "damping_ratio:").size(), 1U);
  EXPECT_EQ(
      problems("damping_ratio:", withReplaced(arm, {{"[arm_link]", "[arm_link, arm_link]"}}) + "damping_ratio:").size(),
      1U);
}

TEST_F(BoomFile, ReadsTheOptionalKeysOfACylinder) {
  expectOne("damping_ratio:", "arm_cylinder_friction: 0.6\ndamping_ratio:",
            "arm_cylinder_friction: 0.6, must be from 0 to 0.5");
  expectOne("damping_ratio:", "arm_cylinder_joint_zero_rad: 0.9\ndamping_ratio:", "arm_cylinder_joint_zero_rad: 0.9");
  expectOne("damping_ratio:", "arm_cylinder_stiffness_std: 2\ndamping_ratio:", "arm_cylinder_stiffness_std");
  expectOne("damping_ratio:", "link_mass_std: 2\ndamping_ratio:", "link_mass_std: 2");
  ASSERT_TRUE(problems("damping_ratio:",
                       "arm_cylinder_friction: 0.02\narm_cylinder_pressure_offset_Pa: -2.0e+4\ndamping_ratio:")
                  .empty());
  const Boom boom = test::loadBoom(urdf_, {file_.string()}).value.value();
  EXPECT_EQ(boom.cylinders()[1].parameters().friction, 0.02);
  EXPECT_EQ(boom.cylinders()[1].parameters().pressure_offset, -2e4);
  EXPECT_EQ(boom.cylinders()[0].parameters().friction, 0.0);
  EXPECT_EQ(boom.cylinders()[0].parameters().friction_std, 0.03);
}

TEST_F(BoomFile, SectionsMayBeLeftOut) {
  yaml_.erase(yaml_.find("sections: ["));
  EXPECT_TRUE(problems("damping_ratio", "damping_ratio").empty());
  const Checked<Boom> made = test::loadBoom(urdf_, {file_.string()});
  EXPECT_TRUE(made.value->sections().empty());
  EXPECT_TRUE(problems("rigid_tolerance:", "sections: []\nrigid_tolerance:").empty());
}

TEST_F(BoomFile, ALinkOfUnknownPartsIsAUniformBarWithANote) {
  yaml_.erase(yaml_.find("arm_middle_section_mass_beyond_kg"));  // and all keys after it
  ASSERT_TRUE(problems("damping_ratio", "damping_ratio").empty());
  const Checked<Boom> made = test::loadBoom(urdf_, {file_.string()});
  ASSERT_EQ(made.notes.size(), 1U);
  EXPECT_EQ(made.notes[0],
            "arm_middle_section_mass_beyond_kg: not given, arm_link counts as a uniform bar between its joints");
  // The bar has 230 kg over 1.70 m and is cut at 0.80 m.
  const RigidBody& part = made.value->sections()[2].part();
  EXPECT_NEAR(part.mass, 230.0 * 0.9 / 1.7, 1e-12);
  EXPECT_NEAR(part.com.x(), 1.25, 1e-15);
  EXPECT_NEAR(part.inertia(1, 1), part.mass * 0.81 / 12.0, 1e-12);
}

TEST_F(BoomFile, TwoSectionsCannotShareAName) {
  BoomParameters parameters = test::shippedBoomParameters();
  parameters.sections.push_back(parameters.sections[0]);
  EXPECT_EQ(Boom::make(urdf_, parameters).problems,
            std::vector<std::string>{"sections: boom_foot, given twice, must be different names"});
  parameters.sections.back().name = "a/b";
  EXPECT_EQ(Boom::make(urdf_, parameters).problems,
            std::vector<std::string>{"sections: a/b, must be names of letters, digits and _"});
}

TEST_F(BoomFile, ReportsUnknownAndMissingKeys) {
  expectOne("rigid_tolerance:", "spare_key: 1.0\nrigid_tolerance:", "spare_key: ");
  EXPECT_EQ(problems("damping_ratio: 0.05", "damping: 0.05").size(), 2U);  // one missing, one unknown
  const std::vector<std::string> found = problems("cylinders: [boom_cylinder,", "cylinders: [bom_cylinder,");
  EXPECT_GT(found.size(), 12U);  // missing keys of one, unknown keys of the other
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

TEST_F(BoomFile, NeedsThreeKeysWithoutCylinders) {
  urdf_ = withReplaced(urdf_, {{"\"base_link\"", "\"chassis\""}, {"\"hammer_hull\"", "\"breaker\""}});
  yaml_ = "root_link: chassis\ntip_link: breaker\ncylinders: []\n";
  EXPECT_TRUE(problems("chassis", "chassis").empty());
  const Checked<Boom> made = test::loadBoom(urdf_, {file_.string()});
  ASSERT_TRUE(made.value);
  EXPECT_FALSE(made.value->parameters().supports);
  // The torques equal those of the whole file's boom held rigid, where cylinders have no influence.
  Boom bare = *made.value, shipped = test::shippedBoom();
  const JointMotion motion{test::workingPosition(), test::kZero, test::kZero};
  const Wrench w_tip{{1000.0, 0.0, -30000.0}, {0.0, 500.0, 0.0}};
  BoomLoads a, b;
  for (auto [boom, loads] : {std::make_pair(&bare, &a), std::make_pair(&shipped, &b)}) {
    boom->move(motion, test::kLevel);
    ASSERT_TRUE(boom->loads(w_tip, true, *loads));
  }
  EXPECT_EQ(a.total, b.total);
  EXPECT_GT(a.total.cwiseAbs().maxCoeff(), 1000.0);
  // Given keys are checked, also for completeness.
  EXPECT_EQ(problems("cylinders: []", "cylinders: []\nsupport_front_x_m: 0.1").size(), 3U);
  expectOne("cylinders: []",
            "cylinders: []\nbulk_modulus_Pa: -1\ndamping_ratio: 0.05\nmode_refresh_angle_rad: 0.001\n"
            "rigid_tolerance: 0.05",
            "bulk_modulus_Pa: -1 Pa, must be");
}

}  // namespace
}  // namespace hammer_loads
