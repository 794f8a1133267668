/// process_bag with a robot description or boom file that cannot be: one line, exit code 1, nothing written.
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>

#include <filesystem>

#include "hammer_loads/settings/load.h"
#include "support/bad_booms.h"
#include "support/command.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;

class BadBoom : public testing::Test {
 protected:
  BadBoom() {
    rosbag::Bag bag(in_.path(), rosbag::bagmode::Write);
    for (int i = 1; i < 100; ++i) {
      sensor_msgs::JointState m;
      m.header.stamp = ros::Time(100.0 + 0.001 * i);
      m.name = {"hammer_crank_joint"};
      m.position = {0.005 * i};
      m.velocity = {5.0};
      bag.write("/hammer/crank", m.header.stamp, m);
    }
  }
  ~BadBoom() override { fs::remove(out_); }

  test::Outcome process(const std::string& urdf, const std::string& more = {}) const {
    return test::runCommand(HAMMER_LOADS_PROCESS_BAG, in_.path() + " " + out_ + " --urdf " + urdf + " --params " +
                                                          configDirectory() + "/boom_eo2621.yaml" + more);
  }
  void expectRefused(const test::Outcome& outcome, const std::string& named) const {
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(test::linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(named), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out_));
  }

  const test::TemporaryFile in_{{}, ".bag"};
  const std::string out_ = in_.path() + ".out";
};

TEST_F(BadBoom, IsRefusedInOneLineAndTheGoodOneIsTaken) {
  for (const test::BadBoom& bad : test::badBooms()) {
    SCOPED_TRACE(bad.what);
    const test::TemporaryFile urdf(bad.urdf, ".urdf");
    const test::TemporaryFile changed(bad.key + ": " + bad.value + "\n");
    expectRefused(process(urdf.path(), bad.key.empty() ? "" : " --params " + changed.path()), bad.named);
  }
  const test::Outcome good = process(test::sourceFile("urdf/eo2621_mo100.urdf"));
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_TRUE(fs::exists(out_));
}

TEST_F(BadBoom, AFileThatCannotBeReadIsNamed) {
  expectRefused(process("/no/such/machine.urdf"), "/no/such/machine.urdf: cannot be read: No such file or directory");
  const test::TemporaryFile empty({}, ".urdf");
  expectRefused(process(empty.path()), empty.path() + ": cannot be read: is empty");
}

}  // namespace
}  // namespace hammer_loads
