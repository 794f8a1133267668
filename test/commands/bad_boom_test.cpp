/// process_bag with a robot description or boom file that cannot be: one line, exit code 1, nothing written.
#include "commands/bag_files.h"
#include "hammer_loads/settings/load.h"
#include "support/bad_booms.h"

namespace hammer_loads {
namespace {

class BadBoom : public test::BagFiles {
 protected:
  BadBoom() {
    rosbag::Bag bag(path("in.bag"), rosbag::bagmode::Write);
    for (int i = 1; i < 100; ++i) {
      sensor_msgs::JointState m;
      m.header.stamp = ros::Time(100.0 + 0.001 * i);
      m.name = {"hammer_crank_joint"};
      m.position = {0.005 * i};
      m.velocity = {5.0};
      bag.write("/hammer/crank", m.header.stamp, m);
    }
  }

  test::Outcome process(const std::string& urdf, const std::string& more = {}) const {
    return run(path("in.bag") + " " + path("out.bag") + " --urdf " + urdf + " --params " + configDirectory() +
               "/boom_eo2621.yaml" + more);
  }
  void expectNothingWritten(const test::Outcome& outcome, const std::string& named) const {
    expectRefused(outcome, {named});
    EXPECT_EQ(names(), std::vector<std::string>{"in.bag"});
  }
};

TEST_F(BadBoom, IsRefusedInOneLineAndTheGoodOneIsTaken) {
  for (const test::BadBoom& bad : test::badBooms()) {
    SCOPED_TRACE(bad.what);
    const test::TemporaryFile urdf(bad.urdf, ".urdf");
    const test::TemporaryFile changed(bad.key + ": " + bad.value + "\n");
    expectNothingWritten(process(urdf.path(), bad.key.empty() ? "" : " --params " + changed.path()), bad.named);
  }
  const test::Outcome good = process(test::sourceFile("urdf/eo2621_mo100.urdf"));
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_EQ(names().size(), 2U);
}

TEST_F(BadBoom, AFileThatCannotBeReadIsNamed) {
  expectNothingWritten(process("/no/such/machine.urdf"),
                       "/no/such/machine.urdf: cannot be read: No such file or directory");
  const test::TemporaryFile empty({}, ".urdf");
  expectNothingWritten(process(empty.path()), empty.path() + ": cannot be read: is empty");
}

}  // namespace
}  // namespace hammer_loads
