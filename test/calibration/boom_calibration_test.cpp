// Identification of a boom from its own cylinders, tested on machines with independently written equations.
#include <gtest/gtest.h>

#include <functional>

#include "calibration/free_boom.h"
#include "hammer_loads/calibration/sensor_check.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::calibration {
namespace {

using test::FreeBoom;

using Pose3 = std::array<double, 3>;

Pose3 anyPose(std::mt19937& random) {
  return {test::between(random, -0.7, 0.4), test::between(random, 0.6, 2.1), test::between(random, -1.7, -0.1)};
}

/// Returns the angles of swing, boom, arm and hammer as their sensors read them [rad].
JointVector readAt(const FreeBoom& machine, const Pose3& q) {
  return test::joints({0.0, q[0] + machine.zero[0], q[1] + machine.zero[1], q[2] + machine.zero[2]});
}

/// Returns the machine with sensors that have no error except noise.
FreeBoom withGoodSensors(FreeBoom machine) {
  machine.zero = machine.offset = machine.gain = {};
  return machine;
}

/// Returns per joint the rms error of a boom file's torques over the rms torque, at poses not used for calibration.
Pose3 staticErrors(const FreeBoom& machine, const BoomParameters& parameters, std::mt19937& random) {
  Boom boom = Boom::make(test::shippedUrdf(), parameters).value.value();
  Pose3 error{}, torque{};
  for (int i = 0; i < 40; ++i) {
    const Pose3 q = anyPose(random), truth = machine.staticTorque(q);
    JointVector position = readAt(machine, q);
    for (std::size_t k = 0; k < 3; ++k)
      position[boom.cylinders()[k].joint()] -= boom.cylinders()[k].parameters().joint_zero;
    boom.move({position, test::kZero, test::kZero}, test::kLevel);
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = boom.steadyTorque(boom.cylinders()[k].joint()) - truth[k];
      error[k] += off * off, torque[k] += truth[k] * truth[k];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) error[k] = std::sqrt(error[k] / torque[k]);
  return error;
}

BoomCalibration calibrated(const FreeBoom& machine, std::mt19937& random, double seconds = 120.0) {
  return calibrateBoom(test::shippedBasis(), {{machine.record(random, seconds), {}}});
}

/// Two minutes of recording correct mass errors of about 10 % and identify unknown seal friction.
TEST(BoomCalibration, CorrectsWrongNominalMasses) {
  std::mt19937 random(1);
  double given = 0.0;
  int joints = 0, weight_as_asked = 0, friction_as_asked = 0;
  for (int i = 0; i < 4; ++i) {
    const FreeBoom machine = withGoodSensors(FreeBoom::drawn(random));
    const BoomCalibration found = calibrated(machine, random);
    ASSERT_EQ(found.problem, "");
    EXPECT_TRUE(found.determined());
    const Pose3 error = staticErrors(machine, found.found, random);
    for (std::size_t k = 0; k < 3; ++k) {
      // A hammer near the vertical has little static torque: its error is within 1.5 % or three standard deviations.
      EXPECT_LT(error[k], std::max(0.015, 3.0 * found.joints[k].part())) << i << found.joints[k].joint;
      ++joints, weight_as_asked += error[k] < 0.015;
      const CylinderFit& cylinder = found.cylinders[k];
      const double truth = machine.friction_force[k] + machine.friction[k] * cylinder.force;
      EXPECT_NEAR(cylinder.friction, truth, std::max(0.3 * truth, 3.0 * cylinder.friction_std)) << i << cylinder.name;
      friction_as_asked += std::abs(cylinder.friction - truth) < 0.3 * truth;
      EXPECT_LT(cylinder.held_out, 2.0 * cylinder.left) << i << cylinder.name;
    }
    for (const double e : staticErrors(machine, test::shippedBasis().parameters, random)) given = std::max(given, e);
  }
  EXPECT_GE(weight_as_asked, static_cast<int>(0.9 * joints)) << joints;
  EXPECT_GE(friction_as_asked, static_cast<int>(0.9 * joints)) << joints;
  EXPECT_GT(given, 0.08);  // the nominal errors are large enough to expose a calibration without effect
}

/// Returns the errors of the static torques at a pose over their stated standard deviations.
Eigen::Vector3d torqueErrors(const BoomModel& model, const BoomFit& fit, const JointVector& pose, const Pose3& truth) {
  const auto torques = [&](const Eigen::VectorXd& x) { return weightTorques(model, x, {pose}); };
  return (torques(fit.x) - Eigen::Map<const Eigen::Vector3d>(truth.data())).cwiseQuotient(stdsOf(fit, torques));
}

/// With sensor errors in zero, offset and gain, torques at single poses lie within two standard deviations.
TEST(BoomCalibration, KnowsHowWellItKnows) {
  std::mt19937 random(2);
  int weights = 0, weights_within = 0, seals = 0, seals_within = 0;
  for (int i = 0; i < 16; ++i) {
    const FreeBoom machine = FreeBoom::drawn(random);
    const std::vector<BoomPoints> points{pointsOf(machine.record(random, 120.0))};
    const BoomModel model(test::shippedBasis(), {TipWeight{}});
    const BoomFit fit = fitBoom(model, rowsOf(model, points));
    EXPECT_TRUE(fit.converged);
    for (int n = 0; n < 4; ++n) {
      const Pose3 q = anyPose(random), truth = machine.staticTorque(q);
      const Eigen::Vector3d errors = torqueErrors(model, fit, readAt(machine, q), truth);
      weights += 3, weights_within += static_cast<int>((errors.array().abs() < 2.0).count());
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto of = [&](BoomUnknown kind) { return model.valueOf(fit.x, kind, k); };
      const double force = 14e6 * 0.2 * machine.cylinders[k].bore_area;
      const auto friction = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(
            1, model.valueOf(x, BoomUnknown::kFrictionForce, k) + force * model.valueOf(x, BoomUnknown::kFriction, k));
      };
      const double truth = machine.friction_force[k] + force * machine.friction[k];
      EXPECT_GE(of(BoomUnknown::kFriction), -1e-9);
      EXPECT_GE(of(BoomUnknown::kFrictionForce), -1e-6);
      ++seals, seals_within += std::abs(friction(fit.x)[0] - truth) < 2.0 * stdsOf(fit, friction)[0];
    }
  }
  EXPECT_GE(weights_within, static_cast<int>(0.88 * weights)) << weights;  // 95.4 % for a normal distribution
  EXPECT_LE(weights_within, static_cast<int>(0.995 * weights)) << weights;
  EXPECT_GE(seals_within, static_cast<int>(0.88 * seals)) << seals;
}

/// Uses the demo machine, which vibrates on its oil while it moves, instead of the machine of free_boom.h.
TEST(BoomCalibration, WeighsABoomOnItsOil) {
  simulation::MachineSettings m = simulation::workingMo100();
  m.hammer.drive_reaction_ratio = 1.0;
  m.on_boom.on = true;
  m.on_boom.seals.friction = 0.02;
  m.on_boom.pressures = {200.0, 2e4, 6e6};
  m.joint_rate = 100.0, m.joint_noise = 2e-4;
  m.drive.start_time = 1e4, m.start_angle = 1e-9;
  m.crank.rate = 10.0;
  m.boom[1] = {-0.2, 0.45, 11.0, 0.0}, m.boom[2] = {1.3, 0.6, 7.0, 1.0}, m.boom[3] = {-0.8, 0.7, 5.0, 2.0};
  m.duration = 60.0;
  const simulation::Session session = simulation::recordSession(m);
  BoomRecording recording;
  recording.joint.resize(4), recording.pressure.resize(3);
  const auto add = [&](Trace& trace, std::int64_t stamp, double value) {
    trace.time.push_back(1e-9 * static_cast<double>(stamp - m.start_stamp)), trace.value.push_back(value);
  };
  for (const simulation::JointReading& reading : session.joints)
    for (std::size_t j = 0; j < 4; ++j) add(recording.joint[j], reading.stamp, reading.position[j]);
  for (const simulation::PressureReading& reading : session.pressures)
    for (std::size_t k = 0; k < 3; ++k)
      add(recording.pressure[k][0], reading.stamp, reading.bore[k]),
          add(recording.pressure[k][1], reading.stamp, reading.rod[k]);
  const BoomCalibration found = calibrateBoom(test::shippedBasis(), {{recording, {}}});
  ASSERT_EQ(found.problem, "");
  EXPECT_TRUE(found.determined());
  // The masses are nominal. Only the rocker hangs where the crank rests, 0.1 m from its mean place over a revolution.
  const double rocker = 0.1 * m.hammer.rocker_mass * m.gravity;
  for (const JointWeight& joint : found.joints) EXPECT_LT(joint.before, 0.015 * joint.torque + rocker) << joint.joint;
  for (const CylinderFit& cylinder : found.cylinders)
    EXPECT_NEAR(cylinder.friction, 0.02 * cylinder.force, 0.3 * 0.02 * cylinder.force) << cylinder.name;
}

/// A boom identified without a load measures the weight that is then hung on its tip.
TEST(BoomCalibration, FindsAWeightOnTheTip) {
  constexpr double kLoad = 500.0, kX = -0.2, kZ = -0.9;  // [kg], [m] from D
  std::mt19937 random(3);
  const FreeBoom machine = withGoodSensors(FreeBoom::drawn(random));
  FreeBoom loaded = machine;
  loaded.hang(kLoad, {kX, kZ});
  const BoomCalibration found = calibrateBoom(
      test::shippedBasis(),
      {{machine.record(random, 120.0), {}}, {loaded.record(random, 60.0), {kLoad, 0.002 * kLoad, kX, kZ}}});
  ASSERT_EQ(found.problem, "");
  ASSERT_TRUE(found.weight_check);
  EXPECT_NEAR(found.weight_check->value, kLoad, 0.02 * kLoad);
  EXPECT_LT(std::abs(found.weight_check->value - kLoad), 2.0 * found.weight_check->deviation);
}

/// Only a known weight separates an error of the bore from an error of the masses.
TEST(BoomCalibration, AKnownWeightSharpensTheCylindersGains) {
  constexpr double kLoad = 500.0, kX = -0.2, kZ = -0.9;
  std::mt19937 random(4);
  FreeBoom machine;
  FreeBoom loaded = machine;
  loaded.hang(kLoad, {kX, kZ});
  const BoomRecording free = machine.record(random, 120.0), hung = loaded.record(random, 120.0);
  const auto gainDeviation = [](const BoomCalibration& c) {
    for (const Estimate& e : c.estimates)
      if (e.key.find("boom_cylinder's bore") == 0) return e.deviation;
    return kNaN;
  };
  BoomBasis basis = test::shippedBasis();
  basis.gain_std = 0.03;  // a bore of another series
  const double alone = gainDeviation(calibrateBoom(basis, {{free, {}}}));
  const double beside = gainDeviation(calibrateBoom(basis, {{free, {}}, {hung, {kLoad, 1.0, kX, kZ}}}));
  EXPECT_LT(beside, 0.5 * alone);
}

TEST(BoomCalibration, NamesPressuresThatContradictTheBoomFile) {
  std::mt19937 random(5);
  const FreeBoom machine = FreeBoom::drawn(random);
  const BoomRecording good = machine.record(random, 60.0);
  const BoomModel model(test::shippedBasis(), {TipWeight{}});
  const auto stated = [&](const BoomRecording& r) { return misreadings(model, pointsOf(r)); };
  EXPECT_TRUE(stated(good).empty()) << stated(good).front();

  BoomRecording bar = good;
  for (auto& chambers : bar.pressure)
    for (Trace& trace : chambers)
      for (double& p : trace.value) p *= 1e-5;
  ASSERT_EQ(stated(bar).size(), 3U);
  EXPECT_NE(stated(bar)[0].find("in bar"), std::string::npos) << stated(bar)[0];

  BoomRecording chambers = good;
  std::swap(chambers.pressure[0][0], chambers.pressure[0][1]);
  ASSERT_EQ(stated(chambers).size(), 1U);
  EXPECT_NE(stated(chambers)[0].find("bore and rod exchanged"), std::string::npos) << stated(chambers)[0];

  BoomRecording cylinders = good;
  std::swap(cylinders.pressure[0], cylinders.pressure[1]);
  ASSERT_EQ(stated(cylinders).size(), 2U);
  EXPECT_NE(stated(cylinders)[0].find("those of arm_cylinder"), std::string::npos) << stated(cylinders)[0];

  BoomRecording degrees = good;
  for (double& q : degrees.joint[2].value) q *= 180.0 / kPi;
  ASSERT_EQ(stated(degrees).size(), 1U);
  EXPECT_NE(stated(degrees)[0].find("arm_joint"), std::string::npos) << stated(degrees)[0];
}

TEST(BoomCalibration, NamesTheJointThatMovedTooLittle) {
  std::mt19937 random(6);
  const FreeBoom machine = FreeBoom::drawn(random);
  const BoomCalibration found = calibrateBoom(test::shippedBasis(), {{machine.record(random, 20.0), {}}});
  EXPECT_NE(found.problem.find("_joint: surely moves at"), std::string::npos) << found.problem;
}

TEST(BoomCalibration, LeavesOutWhatIsHammered) {
  std::mt19937 random(7);
  BoomRecording recording = FreeBoom().record(random, 60.0);
  const BoomPoints whole = pointsOf(recording);
  EXPECT_EQ(whole.left_out, 0U);
  for (double t = 20.0; t < 30.0; t += 0.01) recording.working.push_back(t);
  for (auto& trace : recording.pressure[0]) {  // and a gap
    const auto from = std::lower_bound(trace.time.begin(), trace.time.end(), 40.0);
    const auto to = std::lower_bound(trace.time.begin(), trace.time.end(), 45.0);
    trace.value.erase(trace.value.begin() + (from - trace.time.begin()),
                      trace.value.begin() + (to - trace.time.begin()));
    trace.time.erase(from, to);
  }
  const BoomPoints part = pointsOf(recording);
  EXPECT_NEAR(static_cast<double>(part.left_out), 15.0 / whole.points[0].half_width, 5.0);
  for (const BoomPoint& point : part.points) {
    EXPECT_FALSE(point.time > 20.0 && point.time < 30.0);
    EXPECT_FALSE(point.time > 40.2 && point.time < 44.8);
  }
}

/// Returns errors of static torques at unseen poses over their stated standard deviations, for several days of one
/// machine. Each day has its own pressure offset and tip load, which change the torques by 3 to 12 %.
std::vector<double> errorsFromDays(std::size_t days, std::mt19937& random) {
  constexpr double kLoad = 50.0, kLoadStd = 20.0, kOffsetStd = 1e5;  // [kg], [kg], [Pa]
  const std::complex<double> place(-0.2, -0.9);                      // [m] from D
  std::normal_distribution<> normal;
  const FreeBoom machine = FreeBoom::drawn(random);
  FreeBoom usual = machine;
  usual.hang(kLoad, place);
  std::vector<BoomPoints> points;
  for (std::size_t day = 0; day < days; ++day) {
    FreeBoom today = machine;
    today.hang(std::max(0.0, kLoad + kLoadStd * normal(random)), place);
    for (std::size_t k = 0; k < 3; ++k) today.offset[k] += kOffsetStd * normal(random);
    points.push_back(pointsOf(today.record(random, 30.0)));
  }
  const BoomModel model(test::shippedBasis(), std::vector<TipWeight>(days));
  const BoomFit fit = fitBoom(model, rowsOf(model, points));
  std::vector<double> errors;
  for (int n = 0; n < 4; ++n) {
    const Pose3 q = anyPose(random), truth = usual.staticTorque(q);
    const Eigen::Vector3d found = torqueErrors(model, fit, readAt(machine, q), truth);
    errors.insert(errors.end(), found.data(), found.data() + 3);
  }
  return errors;
}

/// Few days determine their scatter only roughly, and the deviations allow for that. Two days are the hardest case.
TEST(BoomCalibration, KnowsHowWellItKnowsFromFewDays) {
  std::mt19937 random(21);
  double torques = 0.0, within = 0.0;
  for (const auto& [days, machines] : {std::pair<std::size_t, int>{2, 24}, {3, 12}, {5, 6}}) {
    double own = 0.0, own_within = 0.0;
    for (int i = 0; i < machines; ++i)
      for (const double error : errorsFromDays(days, random)) own += 1.0, own_within += std::abs(error) < 2.0;
    EXPECT_GE(own_within, 0.85 * own) << days;  // torque errors of one machine are correlated: 3 to 6 % less by chance
    torques += own, within += own_within;
  }
  EXPECT_GE(within, 0.88 * torques);
  EXPECT_LE(within, 0.99 * torques);
}

/// A bore sensor drifts by 8 bar in the last quarter. The formal standard deviations alone would not reveal it.
TEST(BoomCalibration, WritesNothingWhereWhatIsHeldOutDoesNotFit) {
  std::mt19937 random(23);
  const FreeBoom machine = withGoodSensors(FreeBoom::drawn(random));
  BoomRecording recording = machine.record(random, 120.0);
  EXPECT_TRUE(calibrateBoom(test::shippedBasis(), {{recording, {}}}).determined());
  Trace& trace = recording.pressure[0][0];
  for (std::size_t i = 0; i < trace.time.size(); ++i)
    if (trace.time[i] > 90.0) trace.value[i] += 8e5;
  const BoomCalibration found = calibrateBoom(test::shippedBasis(), {{recording, {}}});
  ASSERT_EQ(found.problem, "");
  EXPECT_FALSE(found.cylinders[0].holds());
  EXPECT_TRUE(found.cylinders[2].holds());
  EXPECT_FALSE(found.determined());
}

/// Returns recordings of one machine on three days, each with its own zeros and offsets.
std::vector<WeighedRecording> threeDays(std::mt19937& random) {
  std::normal_distribution<> normal;
  FreeBoom machine = FreeBoom::drawn(random);
  const FreeBoom usual = machine;
  std::vector<WeighedRecording> recordings;
  for (const char* name : {"monday", "tuesday", "wednesday"}) {
    for (std::size_t k = 0; k < 3; ++k) {
      machine.zero[k] = usual.zero[k] + 1e-3 * normal(random);
      machine.offset[k] = usual.offset[k] + 5e4 * normal(random);
    }
    recordings.push_back({machine.record(random, 40.0), {}, name});
  }
  return recordings;
}

/// A fault changes one sensor's readings in one of three recordings from different days.
TEST(BoomCalibration, NamesTheJointAndTheRecordingOfAFaultySensor) {
  using Readings = std::vector<double>;
  constexpr double kDegree = kPi / 180.0;
  std::mt19937 random(31);
  std::normal_distribution<> normal;
  const std::vector<std::pair<const char*, std::function<void(Readings&)>>> flaws{
      {"leap", [](Readings& q) { std::for_each(q.begin() + 1000, q.end(), [](double& a) { a += kDegree; }); }},
      {"stays", [](Readings& q) { std::fill(q.begin() + 800, q.begin() + 1400, q[800]); }},
      {"stays throughout", [](Readings& q) { std::fill(q.begin(), q.end(), q[0]); }},
      {"offset",
       [](Readings& q) {
         for (double& a : q) a += 3.0 * kDegree;
       }},
      {"scale",
       [](Readings& q) {
         for (double& a : q) a *= 1.1;
       }},
      {"dead band",
       [](Readings& q) {
         double shown = q[0];
         for (double& a : q) a = shown = std::clamp(shown, a - 0.5 * kDegree, a + 0.5 * kDegree);
       }},
      {"noise",
       [&](Readings& q) {
         for (double& a : q) a += 3e-3 * normal(random);
       }},
      {"swing in a half", [](Readings& q) {
         for (std::size_t i = 0; i < q.size() / 2; ++i) q[i] += 0.03 * std::sin(0.5 * static_cast<double>(i));
       }}};
  const std::vector<WeighedRecording> good = threeDays(random);
  EXPECT_EQ(calibrateBoom(test::shippedBasis(), good).problem, "");
  for (std::size_t i = 0; i < flaws.size(); ++i) {
    const std::size_t joint = 1 + i % 3;
    std::vector<WeighedRecording> faulty = good;
    flaws[i].second(faulty[2].recording.joint[joint].value);
    const BoomCalibration refused = calibrateBoom(test::shippedBasis(), faulty);
    const std::string name = test::shippedBoom().chain().jointNames()[joint];
    EXPECT_EQ(refused.problem.find(name + ": its sensor"), 0U) << flaws[i].first << ": " << refused.problem;
    EXPECT_NE(refused.problem.find("wednesday"), std::string::npos) << flaws[i].first << ": " << refused.problem;
    EXPECT_FALSE(refused.determined());
  }
}

/// Encoders without noise repeat a reading as long as the joint rests.
TEST(BoomCalibration, AcceptsACoarseSensorAtRest) {
  std::mt19937 random(32);
  FreeBoom machine;
  machine.joint_noise = 0.0;
  BoomRecording recording = machine.record(random, 40.0);
  constexpr double kStep = 2e-4;  // [rad]
  for (Trace& trace : recording.joint)
    for (double& q : trace.value) q = kStep * std::round(q / kStep);
  EXPECT_TRUE(brokenSensors(test::shippedBoom().chain(), {&recording}, {"encoder"}).empty());
}

}  // namespace
}  // namespace hammer_loads::calibration
