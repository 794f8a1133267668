#include <gtest/gtest.h>

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "boom/vibrating_machine.h"
#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "support/mo100.h"

namespace hammer_loads {
namespace {

using test::PlanarChain;

/// Crank with a steady torque on a boom that vibrates while its pose moves. Everything is smooth between blows.
/// M is that of the hand-made chain, C = 2 zeta M sqrt(M^-1 K). K and poses are given.
class Reference {
 public:
  using State = std::vector<double>;  // crank offset, crank speed, 3 displacements, 3 velocities, time
  enum Index { kOffset, kSpeed, kDisplacement, kVelocity = 5, kTime = 8, kSize };

  Reference(const Boom& boom, double amplitude)
      : mechanism_(test::mechanismOf(test::mo100Parameters())),
        boom_(boom),
        planar_(test::planarEo2621()),
        amplitude_(amplitude) {
    planar_.gravity = 0.0;
    state_[kSpeed] = 13.5;
  }

  /// Returns the slow motion of the pitch joints as joint_states would report it. The swing joint is held.
  JointVector position(double time) const {
    return test::workingPosition() + amplitude_ * test::joints({0.0, std::sin(1.3 * time), std::sin(1.9 * time + 0.4),
                                                                std::sin(1.1 * time - 0.3)});
  }
  double crankAcceleration(const State& y) const {
    const Motion m = motion(mechanism_.linkage(), angle(y));
    const ShaftLoad load = shaftLoadRocker(mechanism_, m, {});
    return (kTorque - load.half_inertia_slope * y[kSpeed] * y[kSpeed]) / (kDriveInertia + load.inertia);
  }
  /// Returns the wrench on the hull without weight.
  Wrench wrench(const State& y) const {
    const CrankMotion crank{angle(y), y[kSpeed], crankAcceleration(y)};
    const HullWrench w = hullWrench(mechanism_, Level::kRocker, crank, {});
    return {Eigen::Vector3d(w.force_x, 0.0, w.force_z), Eigen::Vector3d(0.0, w.torque_y, 0.0)};
  }
  /// Returns the links' momentum, which changes by minus the wrench's impulse [N s, N m s].
  Wrench momentum(const State& y) const {
    const LinkMomentum p = linkMomentum(mechanism_, Level::kRocker, angle(y), y[kSpeed]);
    return {Eigen::Vector3d(p.x, 0.0, p.z), Eigen::Vector3d(0.0, p.about_d, 0.0)};
  }

  /// Advances to `time`. Calls `blow` with the state on either side of each blow.
  template <typename Blow>
  void advanceTo(double time, const Blow& blow) {
    for (;;) {
      State ahead = state_;
      integrate(ahead, time - ahead[kTime], false);
      if (ahead[kOffset] < 2.0 * kPi) {
        state_ = ahead;
        return;
      }
      // A blow lies within. It is reached with the crank's angle as the independent variable.
      integrate(state_, 2.0 * kPi - state_[kOffset], true);
      before_blow_ = true;
      state_[kOffset] = 0.0;
      const State before = state_;
      blow(before, true);
      before_blow_ = false;
      blow(before, false);
    }
  }
  const State& state() const { return state_; }
  Eigen::Vector3d displacement() const { return Eigen::Vector3d(&state_[kDisplacement]); }
  Eigen::Vector3d velocity() const { return Eigen::Vector3d(&state_[kVelocity]); }
  /// Returns the torque that vibration adds: -M x''.
  Eigen::Vector3d torque() const {
    State rate(kSize);
    this->rate(state_, rate);
    return -massMatrix(state_[kTime]) * Eigen::Vector3d(&rate[kVelocity]);
  }

 private:
  static constexpr double kTorque = 165.0, kDriveInertia = 0.8;

  CrankAngle angle(const State& y) const {
    if (before_blow_) return {0.0, Side::kBeforeBlow};
    // Beyond half a revolution the nearest blow is the next one. States past it are its smooth continuation.
    return y[kOffset] > kPi ? CrankAngle{y[kOffset] - 2.0 * kPi, Side::kBeforeBlow}
                            : CrankAngle{y[kOffset], Side::kAfterBlow};
  }
  Eigen::Matrix3d massMatrix(double time) const {
    const JointVector q = position(time);
    return planar_.massMatrix({q[1], q[2], q[3]});
  }
  void rate(const State& y, State& dy) const {
    const JointVector q = position(y[kTime]);
    const Eigen::Matrix3d M = massMatrix(y[kTime]);
    Eigen::Vector3d K;
    for (int i = 0; i < 3; ++i) {
      const Cylinder& cylinder = boom_.cylinders()[static_cast<std::size_t>(i)];
      K[i] = cylinder.jointStiffness(cylinder.at(q[cylinder.joint()]));
    }
    const test::PlanarModes modes = test::planarModes(K, M);
    const double zeta = boom_.parameters().vibration.damping_ratio;
    const Eigen::Matrix3d C = M * modes.shape * (2.0 * zeta * modes.omega).asDiagonal() * modes.shape.transpose() * M;
    const Wrench w = wrench(y);
    // The hand-made chain gives the load torques. At rest and without weight they are J^T w alone.
    const auto Q = planar_.loads({q[1], q[2], q[3]}, {}, {}, {w.force.x(), w.force.z()}, w.torque.y());
    const Eigen::Vector3d x(&y[kDisplacement]), v(&y[kVelocity]);
    const Eigen::Vector3d acceleration = M.inverse() * (Eigen::Vector3d(Q.data()) - C * v - K.cwiseProduct(x));
    dy[kOffset] = y[kSpeed];
    dy[kSpeed] = crankAcceleration(y);
    for (std::size_t i = 0; i < 3; ++i) {
      dy[kDisplacement + i] = v[static_cast<int>(i)];
      dy[kVelocity + i] = acceleration[static_cast<int>(i)];
    }
    dy[kTime] = 1.0;
  }
  /// Integrates over a span of time or of crank angle.
  void integrate(State& y, double span, bool by_angle) const {
    using namespace boost::numeric::odeint;
    const auto system = [&](const State& now, State& dy, double) {
      rate(now, dy);
      if (!by_angle) return;
      for (double& entry : dy) entry /= now[kSpeed];
    };
    const auto stepper = make_controlled(1e-15, 1e-10, runge_kutta_dopri5<State>());
    integrate_adaptive(stepper, system, y, 0.0, span, 0.1 * span);
  }

  Mechanism mechanism_;
  const Boom& boom_;
  PlanarChain<3> planar_;
  double amplitude_;
  bool before_blow_{};
  State state_ = State(kSize);
};

struct Errors {
  double displacement{}, torque{};            ///< largest error over the peak [-]
  double peak_displacement{}, peak_torque{};  ///< [rad], [N m]
  int blows{};
};

/// Runs a session sampled at `rate` [Hz]. A blow ends one step and begins the next.
Errors session(double rate, double amplitude, bool with_mean) {
  Boom boom = test::shippedBoom();
  Reference reference(boom, amplitude);
  boom.vibration().setPose(reference.position(0.0), Eigen::Vector3d::Zero());
  const JointVector still = JointVector::Zero(4);
  Errors errors;
  TorqueStep torque;
  double time = 0.0, span_start = 0.0;
  boom.moveCompliant({reference.position(0.0), still, still}, Eigen::Vector3d::Zero());
  torque.from = boom.hammerTorque(reference.wrench(reference.state()));
  Wrench momentum = reference.momentum(reference.state());
  const auto step = [&](const Reference::State& y) {
    const double h = y[Reference::kTime] - span_start;
    torque.to = boom.hammerTorque(reference.wrench(y));
    const Wrench now = reference.momentum(y);
    torque.mean = with_mean ? boom.hammerTorque({(momentum.force - now.force) / h, (momentum.torque - now.torque) / h})
                            : JointVector(0.5 * (torque.from + torque.to));
    boom.vibration().advance(h, torque);
  };
  const auto begin = [&](const Reference::State& y) {
    span_start = y[Reference::kTime];
    torque.from = boom.hammerTorque(reference.wrench(y));
    momentum = reference.momentum(y);
  };
  double worst_displacement = 0.0, worst_torque = 0.0;
  while (time < 2.5) {
    time += 1.0 / rate;
    boom.moveCompliant({reference.position(time), still, still}, Eigen::Vector3d::Zero());
    reference.advanceTo(time, [&](const Reference::State& y, bool before) {
      before ? step(y) : begin(y);
      errors.blows += before ? 1 : 0;
    });
    step(reference.state());
    begin(reference.state());
    const JointVector x = boom.vibration().displacement(), t = boom.vibration().torque();
    const Eigen::Vector3d exact_x = reference.displacement(), exact_t = reference.torque();
    worst_displacement = std::max(worst_displacement, (x.tail<3>() - exact_x).cwiseAbs().maxCoeff());
    worst_torque = std::max(worst_torque, (t.tail<3>() - exact_t).cwiseAbs().maxCoeff());
    errors.peak_displacement = std::max(errors.peak_displacement, exact_x.cwiseAbs().maxCoeff());
    errors.peak_torque = std::max(errors.peak_torque, exact_t.cwiseAbs().maxCoeff());
  }
  errors.displacement = worst_displacement / errors.peak_displacement;
  errors.torque = worst_torque / errors.peak_torque;
  return errors;
}

/// Checks every bound of the session and records the largest errors.
void expectWithin(const Errors& errors, double bound) {
  EXPECT_LE(errors.displacement, bound);
  EXPECT_LE(errors.torque, bound);
  EXPECT_GE(errors.blows, 10);
  EXPECT_GT(errors.peak_displacement, 1e-3);
  testing::Test::RecordProperty("displacement", format("%.2g", errors.displacement));
  testing::Test::RecordProperty("torque", format("%.2g", errors.torque));
}

constexpr double kMoving = 0.1;  // [rad], up to 0.19 rad/s

// Forces are linear between samples. The error is that of the polygon through the samples of the pulse.
TEST(VibrationSession, FollowsASteadyPoseAt1000Hz) { expectWithin(session(1000.0, 0.0, false), 1e-3); }
TEST(VibrationSession, FollowsASteadyPoseAt200Hz) { expectWithin(session(200.0, 0.0, false), 1e-2); }
TEST(VibrationSession, FollowsAMovingPoseAt1000Hz) { expectWithin(session(1000.0, kMoving, false), 1e-3); }
TEST(VibrationSession, FollowsAMovingPoseAt200Hz) { expectWithin(session(200.0, kMoving, false), 1e-2); }

// The exact mean of the wrench, from the links' momentum, loses no impulse. Errors at a steady pose are far smaller.
TEST(VibrationSession, FollowsASteadyPoseAt1000HzWithMeans) { expectWithin(session(1000.0, 0.0, true), 1e-6); }
TEST(VibrationSession, FollowsASteadyPoseAt200HzWithMeans) { expectWithin(session(200.0, 0.0, true), 2e-4); }
TEST(VibrationSession, FollowsAMovingPoseAt1000HzWithMeans) { expectWithin(session(1000.0, kMoving, true), 1e-3); }
TEST(VibrationSession, FollowsAMovingPoseAt200HzWithMeans) { expectWithin(session(200.0, kMoving, true), 2e-3); }

}  // namespace
}  // namespace hammer_loads
