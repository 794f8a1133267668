#include "hammer_loads/boom/chain.h"

#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "boom/booms.h"
#include "hammer_loads/boom/chain_pose.h"

namespace hammer_loads {
namespace {

using test::joints;

const char* const kMass =
    "<inertial><mass value=\"7\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>"
    "</inertial>";

std::string link(const std::string& name, const std::string& inside = kMass) {
  return "<link name=\"" + name + "\">" + inside + "</link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/>" + more + "</joint>";
}

std::string robot(const std::string& inside) { return "<robot name=\"r\">" + inside + "</robot>"; }

/// Returns a robot with three joints of different types about oblique axes, and with bodies beside the chain.
std::string oddRobot() {
  return robot(
      link("base", "") + link("a") + link("b") + link("c") + link("tip", "") + link("beside") + link("loose") +
      joint("turn", "continuous", "base", "a",
            "<origin xyz=\"0.1 0.2 0.3\" rpy=\"0.3 -0.2 1\"/><axis xyz=\"1 2 -0.5\"/>") +
      joint("slide", "prismatic", "a", "b", "<origin xyz=\"0.5 0 -0.3\" rpy=\"1.3 0.2 0\"/><axis xyz=\"0 0.6 0.8\"/>") +
      joint("hinge", "revolute", "b", "c", "<origin xyz=\"0 1 0\" rpy=\"0 0 0.4\"/><axis xyz=\"0 1 0\"/>") +
      joint("end", "fixed", "c", "tip", "<origin xyz=\"0.7 0.1 0\" rpy=\"0 0.5 0\"/>") +
      joint("bolted", "fixed", "c", "beside", "<origin xyz=\"0 0 2\"/>") + joint("flap", "continuous", "c", "loose"));
}

Checked<Chain> oddChain() { return Chain::make(oddRobot(), {"base", "tip", {"turn", "hinge"}}); }

TEST(Chain, IncludesFixedNeighboursAndReportsMovingOnes) {
  const Checked<Chain> made = oddChain();
  ASSERT_TRUE(made.value);
  EXPECT_EQ(made.value->link(3).body.mass, 14.0);
  EXPECT_NEAR(made.value->link(3).body.com.z(), 1.0, 1e-15);
  ASSERT_EQ(made.notes.size(), 1U);
  EXPECT_EQ(made.notes[0], "robot_description: link loose: 7 kg move beside the chain and are not counted");
}

TEST(Chain, ForwardKinematicsAndJacobianEqualKdl) {
  const Checked<Chain> shipped = Chain::make(test::shippedUrdf(), {});
  ASSERT_TRUE(shipped.value) << shipped.problems.front();
  const Checked<Chain> odd = oddChain();
  std::mt19937 random(5);
  for (const Chain& chain : {*shipped.value, *odd.value}) {
    KDL::ChainFkSolverPos_recursive kinematics(chain.kdl());
    KDL::ChainJntToJacSolver jacobian(chain.kdl());
    KDL::JntArray q(chain.kdl().getNrOfJoints());
    KDL::Jacobian J_B(q.rows());
    ChainPose pose;
    for (int i = 0; i < 1000; ++i) {
      q.data = test::randomPosition(chain, random);
      forwardKinematics(chain, q.data, pose);
      for (int k = 1; k < chain.links(); ++k) {
        KDL::Frame expected;
        kinematics.JntToCart(q, expected, k);
        for (int r = 0; r < 3; ++r) {
          EXPECT_NEAR(pose.link(k).translation()[r], expected.p(r), 4e-15);
          for (int c = 0; c < 3; ++c) EXPECT_NEAR(pose.link(k).linear()(r, c), expected.M(r, c), 2e-15);
        }
      }
      jacobian.JntToJac(q, J_B);
      const Jacobian J_T = tipJacobian(pose);
      for (int j = 0; j < chain.joints(); ++j) {
        const Eigen::Vector3d v = pose.tip().linear() * J_T.col(j).head<3>();
        const Eigen::Vector3d omega = pose.tip().linear() * J_T.col(j).tail<3>();
        EXPECT_LT((v - J_B.data.col(j).head<3>()).norm(), 1e-14);
        EXPECT_LT((omega - J_B.data.col(j).tail<3>()).norm(), 1e-14);
      }
    }
  }
}

struct Bad {
  const char* what;
  std::string urdf;
  ChainRequest request;
  std::vector<std::string> problems;  ///< beginning of each problem
};

void expectProblems(const Bad& bad) {
  const Checked<Chain> made = Chain::make(bad.urdf, bad.request);
  EXPECT_FALSE(made.value) << bad.what;
  ASSERT_EQ(made.problems.size(), bad.problems.size())
      << bad.what << ": " << (made.problems.empty() ? "" : made.problems[0]);
  for (std::size_t i = 0; i < bad.problems.size(); ++i) {
    EXPECT_EQ(made.problems[i].rfind("robot_description: " + bad.problems[i], 0), 0U)
        << bad.what << ": " << made.problems[i];
    EXPECT_EQ(made.problems[i].find('\n'), std::string::npos) << bad.what;
  }
}

TEST(Chain, ReportsEachFault) {
  const std::string two = link("base_link", "") + link("hammer_hull");
  const std::string hinge = joint("j", "revolute", "base_link", "hammer_hull");
  const std::string negative = link("hammer_hull",
                                    "<inertial><mass value=\"-3\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
                                    "iyy=\"1\" iyz=\"0\" izz=\"3\"/></inertial>");
  std::string many = link("base_link", "") + link("l0", "");
  many += joint("j0", "continuous", "base_link", "l0");
  for (int i = 1; i < 9; ++i) {
    many += link(format("l%d", i)) + joint(format("j%d", i), "continuous", format("l%d", i - 1), format("l%d", i));
  }
  for (const Bad& bad : {
           Bad{"no XML", "hello", {}, {"cannot be read: "}},
           Bad{"empty", "", {}, {"cannot be read: "}},
           Bad{"cut off", robot(two + hinge).substr(0, 200), {}, {"cannot be read: "}},
           Bad{"two roots", robot(two), {}, {"cannot be read: "}},
           Bad{"tip missing", robot(two + hinge), {"base_link", "hull", {}}, {"link hull: not in the model"}},
           Bad{"both missing",
               robot(two + hinge),
               {"b", "t", {}},
               {"link b: not in the model", "link t: not in the model"}},
           Bad{"wrong way",
               robot(two + hinge),
               {"hammer_hull", "base_link", {}},
               {"link base_link: hangs on base_link, must hang on hammer_hull"}},
           Bad{"joint missing",
               robot(two + hinge),
               {"base_link", "hammer_hull", {"boom_joint"}},
               {"joint boom_joint: not in the model"}},
           Bad{"joint beside",
               robot(two + hinge + link("x") + joint("k", "revolute", "base_link", "x")),
               {"base_link", "hammer_hull", {"k"}},
               {"joint k: not a moving joint between base_link and hammer_hull"}},
           Bad{"nothing moves", robot(two + joint("j", "fixed", "base_link", "hammer_hull")), {}, {"0 moving joints"}},
           Bad{"too many", robot(many), {"base_link", "l8", {}}, {"9 moving joints"}},
           Bad{"floats",
               robot(two + joint("j", "floating", "base_link", "hammer_hull")),
               {},
               {"joint j: must be revolute", "0 moving joints"}},
           Bad{"mimics",
               robot(two + joint("j", "revolute", "base_link", "hammer_hull", "<mimic joint=\"j\"/>")),
               {},
               {"joint j: mimics j"}},
           Bad{"negative mass",
               robot(link("base_link", "") + negative + hinge),
               {},
               {"mass of link hammer_hull: -3 kg, must be from 0",
                "inertia of link hammer_hull: principal moments 1, 1, 3"}},
           Bad{"massless",
               robot(link("base_link", "") + link("hammer_hull", "") + hinge),
               {},
               {"mass beyond joint j: 0 kg, must be > 0"}},
       }) {
    expectProblems(bad);
  }
}

}  // namespace
}  // namespace hammer_loads
