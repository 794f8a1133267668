#include "hammer_loads/pipeline/boom_follower.h"

#include <gtest/gtest.h>

#include "boom/booms.h"
#include "hammer_loads/util/constants.h"
#include "support/constants.h"

namespace hammer_loads::test {
namespace {

constexpr double kStrikingDistance = 0.1975;
const std::vector<double> kWorking{0.2, -0.35, 1.20, -0.85};

PipelineSettings modelled(BoomModel model) {
  PipelineSettings s;
  s.boom = model;
  s.joint_max_age = 0.2;
  s.gravity = kGravity;
  s.boom_acceleration = BoomAcceleration::kDifference;
  return s;
}

/// A step without blows under a steady load.
WrenchHistory steadyStep(double duration, const HullWrench& w) {
  WrenchHistory step;
  step.count = 1;
  step.pieces[0].duration = duration;
  step.pieces[0].from = step.pieces[0].to = step.pieces[0].mean = w;
  return step;
}

HalfSinePulse pulseOf(double length) {
  HalfSinePulse pulse;
  pulse.amplitude = 8e3;
  pulse.frequency = kPi / length;
  return pulse;
}

/// A boom that stands at the working pose; a sample every millisecond.
class Follower {
 public:
  explicit Follower(BoomModel model, Boom boom = shippedBoom())
      : follower(std::move(boom), modelled(model), kStrikingDistance) {}

  const BoomState& sample(const HullWrench& w, const WrenchHistory& step, int ms = 1) {
    now += ms * kMs;
    follower.jointStates(now, kFour, kWorking, {});
    return follower.sample({now, w}, step);
  }
  const BoomState& sample(const HullWrench& w) { return sample(w, steadyStep(1e-3, w)); }

  BoomFollower follower;
  StampNs now{};
};

constexpr HullWrench kLoad{-900.0, 7000.0, 300.0};

/// One step with a load of NaN resets the vibration. Its loads are withheld until the disturbance would have decayed,
/// and then equal those of an undisturbed follower.
TEST(BoomFollower, ResetsAVibrationThatRunsAwayAndWithholdsItForAWhile) {
  Follower struck(BoomModel::kCompliant), other(BoomModel::kCompliant);
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(struck.sample(kLoad).fault) << "the channel";
  EXPECT_EQ(struck.follower.divergences(), 0U);
  const BoomState& first = struck.sample({kNaN, kNaN, kNaN});
  ASSERT_TRUE(first.fault);
  EXPECT_EQ(first.fault->kind, JointFault::Kind::kRunAway);
  EXPECT_EQ(struck.follower.divergences(), 1U);
  int withheld = 1;
  while (struck.sample(kLoad).fault) {
    ASSERT_EQ(struck.follower.state().fault->kind, JointFault::Kind::kRunAway);
    ASSERT_LT(++withheld, 10001);
  }
  EXPECT_GT(withheld, 50) << "a boom swings for some periods";
  EXPECT_EQ(struck.follower.divergences(), 1U);
  for (int i = 0; i < 10000; ++i) struck.sample(kLoad), other.sample(kLoad);
  const JointVector torque = struck.follower.state().loads.total;
  ASSERT_TRUE(torque.allFinite());
  EXPECT_NEAR((torque - other.follower.state().loads.total).norm(), 0.0, 1e-3 * torque.norm());
}

TEST(BoomFollower, ALoadThatStaysIsCarriedAsOnARigidBoom) {
  Follower rigid(BoomModel::kRigid), compliant(BoomModel::kCompliant);
  rigid.sample(kLoad);
  for (int i = 0; i < 20000; ++i) compliant.sample(kLoad);
  const BoomState& state = compliant.follower.state();
  EXPECT_TRUE(state.choice.compliant);
  // The initial vibration decays by exp(-zeta omega t): below 1e-7 after 20 s at zeta = 0.05 and some 3 Hz.
  EXPECT_TRUE(state.loads.total.isApprox(rigid.follower.state().loads.total, 1e-7));
  EXPECT_TRUE(state.tip.velocity.isZero(1e-6));
  const double deflection = state.tip.displacement.z();
  EXPECT_GT(deflection, 0.0);
  // A force along z alone deflects the hull by its reduced stiffness; force x and moment are a tenth of it here.
  EXPECT_NEAR(deflection, kLoad.force_z / state.reduced.stiffness, 0.5 * deflection);
}

TEST(BoomFollower, HoldsDownAgainstTheMeanHoldDownForceAtTheTool) {
  Follower rigid(BoomModel::kRigid);
  rigid.follower.turnEnded(std::nullopt, 3000.0);
  EXPECT_FALSE(rigid.sample({}).hold_down) << "before any sample nothing is known";
  rigid.follower.turnEnded(std::nullopt, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(rigid.follower.state().hold_down);
  EXPECT_EQ(rigid.follower.firstToGive(), "");
  rigid.follower.turnEnded(std::nullopt, 3000.0);
  ASSERT_TRUE(rigid.follower.state().hold_down);
  const HoldDown once = *rigid.follower.state().hold_down;
  EXPECT_EQ(rigid.follower.firstToGive(), "boom_cylinder");
  EXPECT_EQ(once.least, once.cylinder[0]);
  EXPECT_TRUE(once.least >= 1.0);

  // Check by hand with moments about the rear edge: the force at the tool's end against the weight of all masses.
  const Boom& boom = rigid.follower.boom();
  const hammer_loads::Pose& X_BH = boom.pose().tip();
  const Eigen::Vector3d tool = X_BH * Eigen::Vector3d(-kStrikingDistance, 0.0, -0.75);
  const Eigen::Vector3d force = 3000.0 * X_BH.linear().col(2);
  const double rear = boom.parameters().supports->rear_x;
  double weight = 0.0;
  for (int i = 0; i < boom.chain().links(); ++i) {
    const RigidBody& body = boom.chain().link(i).body;
    weight += body.mass * kGravity * ((boom.pose().link(i) * body.com).x() - rear);
  }
  EXPECT_EQ(once.edge, 2);
  EXPECT_NEAR(once.machine, weight / (force.z() * (tool.x() - rear) - force.x() * tool.z()), 1e-9);
  rigid.follower.turnEnded(std::nullopt, 6000.0);
  EXPECT_NEAR(rigid.follower.state().hold_down->machine, 0.5 * once.machine, 1e-12);

  // Without cylinders only the machine's weight is left.
  BoomParameters parameters = boom.parameters();
  parameters.cylinders.clear();
  Follower bare(BoomModel::kRigid, *Boom::make(shippedUrdf(), parameters).value);
  bare.sample({});
  bare.follower.turnEnded(std::nullopt, 3000.0);
  EXPECT_EQ(bare.follower.firstToGive(), "rear edge");
}

Boom boomWithoutFile() { return std::move(*Boom::make(shippedUrdf()).value); }

TEST(BoomFollower, AutoIsCompliantUntilALongPulseShowsThatRigidSuffices) {
  Follower automatic(BoomModel::kAuto);
  automatic.sample(kLoad);
  EXPECT_TRUE(automatic.sample(kLoad).choice.compliant);
  EXPECT_FALSE(automatic.follower.state().choice.judged);
  const double slowest = 1.0 / automatic.follower.state().frequency[0];

  automatic.follower.turnEnded(pulseOf(100.0 * slowest), 300.0);
  EXPECT_FALSE(automatic.sample(kLoad).choice.compliant);
  EXPECT_TRUE(automatic.follower.state().loads.vibration.isZero(0.0));
  BoomChoice choice = automatic.follower.state().choice;
  EXPECT_TRUE(choice.judged);
  EXPECT_LT(choice.rigid_error, choice.rigid_tolerance);
  EXPECT_EQ(choice.rigid_tolerance, 0.05);
  EXPECT_NEAR(choice.pulse_length, 100.0 * slowest, 1e-9);
  EXPECT_NEAR(choice.lowest_frequency, 1.0 / slowest, 1e-9);

  // A pulse of the hammer lasts 18 ms.
  automatic.follower.turnEnded(pulseOf(0.018), 300.0);
  choice = automatic.sample(kLoad).choice;
  EXPECT_TRUE(choice.compliant);
  EXPECT_GT(choice.rigid_error, 0.5);
  // The vibration went on meanwhile, as in a boom that is always compliant.
  Follower always(BoomModel::kCompliant);
  for (int i = 0; i < 4; ++i) always.sample(kLoad);
  const JointVector went_on = automatic.follower.state().loads.vibration,
                    went = always.follower.state().loads.vibration;
  EXPECT_LT((went_on - went).norm(), 1e-4 * went.norm()) << "but for levers that the vibration itself changes";
  // A revolution without a pulse does not change the choice.
  automatic.follower.turnEnded(std::nullopt, 300.0);
  EXPECT_TRUE(automatic.sample(kLoad).choice.compliant);
}

TEST(BoomFollower, TakesABoomWithoutCylindersAsRigid) {
  Follower automatic(BoomModel::kAuto, boomWithoutFile());
  automatic.sample(kLoad);
  automatic.follower.turnEnded(pulseOf(0.018), 300.0);
  const BoomState& state = automatic.sample(kLoad);
  ASSERT_FALSE(state.fault);
  EXPECT_FALSE(state.choice.compliant);
  EXPECT_FALSE(state.choice.judged);
  EXPECT_FALSE(state.hold_down);
  EXPECT_TRUE(std::isinf(state.reduced.mass));
  EXPECT_EQ(state.frequency.size(), 0);
  Follower rigid(BoomModel::kRigid);
  rigid.sample(kLoad);
  EXPECT_EQ(rigid.follower.state().loads.total, state.loads.total);
}

TEST(BoomFollower, TakesTheBoomAsRigidAtAZeroMomentArm) {
  BoomParameters parameters = shippedBoomParameters();
  // The arm's cylinder, in line with its joint at the working pose.
  CylinderParameters& arm = parameters.cylinders[1];
  arm.base_x = 2.60 - 1.3, arm.base_z = 0.0;
  arm.rod_x = 0.4 * std::cos(1.20), arm.rod_z = 0.4 * std::sin(1.20);
  arm.closed_length = 1.0, arm.stroke = 0.99;
  const Checked<Boom> made = Boom::make(shippedUrdf(), parameters);
  ASSERT_TRUE(made.value) << made.problems.front();
  Follower compliant(BoomModel::kCompliant, *made.value);
  compliant.sample(kLoad);
  const BoomState& state = compliant.sample(kLoad);
  ASSERT_FALSE(state.fault);
  EXPECT_TRUE(state.zero_moment_arm);
  EXPECT_FALSE(state.choice.compliant);
  EXPECT_TRUE(state.loads.cylinder[1].zero_moment_arm);
  EXPECT_TRUE(state.loads.total.allFinite());
  Follower rigid(BoomModel::kRigid, *made.value);
  rigid.sample(kLoad);
  EXPECT_EQ(state.loads.total, rigid.follower.state().loads.total);
}

/// A force within the error of the boom's weight is not taken as contact with rock; twice that error is.
TEST(MeasuredRock, ShowsAboveTheErrorOfTheBoomsWeight) {
  const Boom shipped = shippedBoom();
  const double least = 0.05 * kGravity * massFrom(shipped.chain(), shipped.pose(), 1).mass;
  for (const double part : {0.5, 2.0}) {
    Follower measured(BoomModel::kCompliant);
    BoomFollower& follower = measured.follower;
    for (int i = 1; i < 5000; ++i) {
      const BoomState& state = measured.sample({});
      ASSERT_FALSE(state.fault);
      const Boom& boom = follower.boom();
      const JointVector torque = state.loads.weight + boom.hammerTorque({{0.0, 0.0, part * least},
                                                                         {0.0, kStrikingDistance * part * least, 0.0}});
      for (std::size_t c = 0; c < boom.cylinders().size(); ++c) {
        const double push = -torque[boom.cylinders()[c].joint()] / boom.cylinderPosition(c).arm;
        follower.pressure(measured.now, c, Chamber::kRod, 0.0);
        follower.pressure(measured.now, c, Chamber::kBore, push / boom.cylinders()[c].boreArea());
      }
    }
    EXPECT_TRUE(follower.contactKnown());
    EXPECT_EQ(follower.boom().vibration().contact() > 0.0, part > 1.0);
  }
}

}  // namespace
}  // namespace hammer_loads::test
