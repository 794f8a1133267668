/// process_bag with a robot description and with sensors of the hull and its cylinders in the bag.
#include "commands/boom_bag.h"
#include "hammer_loads/bench/signal_error.h"

namespace hammer_loads {
namespace {

using test::BoomBag;
using test::InputBag;
using test::machineOfBag;

/// Oil 30 % softer than the boom file says, known by every sensor; against the machine's own equations.
TEST_F(BoomBag, StatesTheSectionLoadsOfAMachineOnSofterOil) {
  simulation::MachineSettings m = machineOfBag(true);
  m.duration = 7.0, m.drive.stop_time = 1e9;
  m.hammer.drive_reaction_ratio = 1.0;
  m.on_boom.on = true, m.on_boom.oil_stiffness = 0.7;
  m.on_boom.imu = {1000.0, 0.0, 0.0, 0.0, 0.1, 0.003};
  m.on_boom.pressures = {250.0, 2e4, 6e6};
  const simulation::Session session = simulation::recordSession(m);
  {
    InputBag in(path("in.bag"), session);
    for (const simulation::HullImuReading& imu : session.imu)
      in.writeImu(timeOf(imu.stamp), {Eigen::Vector3d(imu.specific_force.data()), Eigen::Vector3d(imu.rate.data())});
    for (const simulation::PressureReading& p : session.pressures)
      for (std::size_t i = 0; i < 3; ++i)
        in.writePressures(timeOf(p.stamp), simulation::kBoomCylinders[i], p.bore[i], p.rod[i]);
  }
  const test::Outcome outcome = process("out.bag", "boom: compliant\nhull_motion: imu\nboom_stiffness: identified\n",
                                        "--imu-topic /machine/imu --pressures-topic /machine/oil");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::map<StampNs, const simulation::OnBoomTruth*> truth;
  for (std::size_t i = 0; i < session.crank.size(); ++i) truth[session.crank[i].stamp] = &session.on_boom[i];
  const StampNs from = m.start_stamp + 4000000000;
  accuracy::SignalError section[3], torque[3];
  for (const SectionLoads& loads : test::messagesIn<SectionLoads>(path("out.bag"), "/hammer_loads/section_loads")) {
    const StampNs stamp = stampOf(loads.header.stamp);
    for (std::size_t i = 0; stamp > from && i < 3; ++i)
      section[i].add(loads.section[i].load.torque.y, truth.at(stamp)->cut[i].torque_y);
  }
  for (const JointLoads& loads : test::messagesIn<JointLoads>(path("out.bag"), "/hammer_loads/joint_loads")) {
    const StampNs stamp = stampOf(loads.header.stamp);
    for (std::size_t i = 0; stamp > from && i < 3; ++i) {
      const double weight = loads.joint[i + 1].weight_torque;
      torque[i].add(loads.joint[i + 1].total_torque - weight, -truth.at(stamp)->hold[static_cast<int>(i)] - weight);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::printf("section %.2f %% of its range, joint torque %.2f %% rms\n", 100 * section[i].rmsOfRange(),
                100 * torque[i].rms());
    EXPECT_GT(section[i].count, 2900);
    EXPECT_LT(section[i].rmsOfRange(), 0.04);
    EXPECT_GT(section[i].correlation(), 0.99);
    EXPECT_LT(torque[i].rms(), 0.05);
  }
}

}  // namespace
}  // namespace hammer_loads
