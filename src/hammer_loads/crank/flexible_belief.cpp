#include "hammer_loads/crank/flexible_belief.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;
using Effect = Eigen::Matrix<double, 9, ConstantErrors::kSize>;
using FlexibleVector = Eigen::Matrix<double, 9, 1>;

constexpr double kFlexibleNoiseStep = 2e-3;   // [s] step over which the process noise is spread
constexpr double kMostInertiaChange = 0.3;    // of a logarithm by one sample
constexpr double kMostStiffnessChange = 0.1;  // likewise
constexpr double kMostLogStiffness = 1.4;     // a factor of two of the frequency either way
constexpr double kMostTwist = 1.0;            // [rad]: more is a diverged filter

FlexibleMatrix joint(const Belief& b) noexcept {
  FlexibleMatrix p;
  p.topLeftCorner<5, 5>() = b.covariance;
  p.rightCols<4>() = b.motor->covariance;
  p.bottomLeftCorner<4, 5>() = b.motor->covariance.topRows<5>().transpose();
  return p;
}

void setJoint(const FlexibleMatrix& p, Belief& b) noexcept {
  b.covariance = p.topLeftCorner<5, 5>();
  b.motor->covariance = p.rightCols<4>();
}

Effect jointEffect(const Belief& b) noexcept {
  Effect effect;
  effect << b.by_error, b.motor->by_error;
  return effect;
}

void setEffect(const Effect& effect, Belief& b) noexcept {
  b.by_error = effect.topRows<5>();
  b.motor->by_error = effect.bottomRows<4>();
}

void apply(const FlexibleMatrix& f, Belief& b) noexcept {
  setJoint(f * joint(b) * f.transpose(), b);
  setEffect(f * jointEffect(b), b);
  b.motor->by_odds = (f * b.motor->by_odds).eval();
}

/// speed: of crank and motor together; torque: of the motor.
void addNoise(const CrankWalks& walks, const CouplingLaw& law, double h, Belief& b) noexcept {
  const double torque = square(walks.torque) * h, speed = square(walks.speed) * h, by_torque = h / law.motor_inertia;
  FlexibleMatrix p = joint(b);
  const auto add = [&p](Eigen::Index i, Eigen::Index k, double value) {
    p(i, k) += value;
    if (i != k) p(k, i) += value;
  };
  for (const auto& [angle, rate] :
       {std::pair<Eigen::Index, Eigen::Index>{Belief::kAngle, Belief::kSpeed}, {kMotorAngle, kMotorSpeed}}) {
    add(angle, angle, speed * h * h / 3.0);
    add(rate, rate, speed);
    add(angle, rate, 0.5 * speed * h);
  }
  add(Belief::kAngle, kMotorAngle, speed * h * h / 3.0);
  add(Belief::kSpeed, kMotorSpeed, speed);
  add(Belief::kAngle, kMotorSpeed, 0.5 * speed * h);
  add(Belief::kSpeed, kMotorAngle, 0.5 * speed * h);
  add(kMotorSpeed, kMotorSpeed, torque * square(by_torque) / 3.0);
  add(Belief::kTorque, kMotorSpeed, 0.5 * torque * by_torque);
  add(Belief::kTorque, Belief::kTorque, torque);
  add(Belief::kInertia, Belief::kInertia, square(walks.inertia) * h);
  setJoint(p, b);
}

/// Derivatives of the crank's acceleration: by the coupling's moment times those of the moment, and all others.
struct AccelerationSlopes {
  Eigen::Matrix<double, 1, 9> by_moment{Eigen::Matrix<double, 1, 9>::Zero()}, others{by_moment};
};

AccelerationSlopes accelerationSlopes(const ShaftModel& model, const ShaftState& state) noexcept {
  constexpr double kStep = 1e-5;  // [rad]
  const ShaftLoad load = model(state.position.angle);
  const CouplingLaw law = lawOf(*model.coupling(), state);
  const double inv = 1.0 / (law.crank_inertia + load.inertia), e = acceleration(model, load, state);
  const double spring = law.stiffness * state.twist, slip = law.damping * (state.motor_speed - state.speed);
  const double moment = spring + slip, on_crank = law.crank_inertia / (law.crank_inertia + law.motor_inertia);
  CrankAngle low = state.position.angle, high = low;  // with the twist
  low.offset -= kStep;
  high.offset += kStep;
  AccelerationSlopes s;
  s.by_moment[kMotorAngle] = law.stiffness * inv;
  s.by_moment[Belief::kAngle] = -s.by_moment[kMotorAngle];
  s.by_moment[kMotorSpeed] = law.damping * inv;
  s.by_moment[Belief::kSpeed] = -s.by_moment[kMotorSpeed];
  s.by_moment[kStiffness] = (spring + 0.5 * slip) * inv;
  s.others[Belief::kAngle] =
      (acceleration(model, model(high), state) - acceleration(model, model(low), state)) / (2.0 * kStep);
  s.others[Belief::kSpeed] = -2.0 * load.half_inertia_slope * state.speed * inv;
  const double by_inertia = -law.crank_inertia * (e + load.hull_acceleration) * inv;
  s.others[Belief::kInertia] = moment * inv + by_inertia;
  s.others[kOdds] = (2.0 * on_crank - 1.0) * moment * inv - (1.0 - on_crank) * by_inertia;
  return s;
}

}  // namespace

ShaftMatrix effectOfShare(const MotorSide& motor) noexcept {
  const Eigen::Matrix<double, 5, 1> by_odds = motor.by_odds.head<5>();
  return motor.odds_variance * by_odds * by_odds.transpose();
}

void beginMotor(const Coupling& coupling, double torque_deviation, Belief& b) noexcept {
  const double share = coupling.motor_share,
               stiffness_variance = b.motor ? b.motor->covariance(kStiffness, MotorSide::kStiffness)
                                            : square(coupling.stiffness_deviation);
  b.state.twist = 0.0;
  b.state.motor_speed = b.state.speed;
  b.motor.emplace();
  MotorSide& m = *b.motor;
  m.covariance(Belief::kAngle, MotorSide::kAngle) = m.covariance(kMotorAngle, MotorSide::kAngle) =
      b.covariance(Belief::kAngle, Belief::kAngle);
  m.covariance(Belief::kSpeed, MotorSide::kSpeed) = m.covariance(kMotorSpeed, MotorSide::kSpeed) =
      b.covariance(Belief::kSpeed, Belief::kSpeed);
  m.covariance(kStiffness, MotorSide::kStiffness) = stiffness_variance;
  m.odds_variance = square(coupling.share_deviation / (share * (1.0 - share)));
  m.by_error.row(MotorSide::kAngle) = b.by_error.row(Belief::kAngle);
  const CouplingLaw law = lawOf(coupling, b.state);
  const double twist = torque_deviation / law.stiffness;
  b.covariance(Belief::kAngle, Belief::kAngle) += square(twist);
  b.covariance(Belief::kSpeed, Belief::kSpeed) += square(2.0 * kPi * coupling.frequency * twist);
}

int predictFlexible(const ShaftModel& model, const CrankWalks& walks, const BlowPrior& drawn, bool contact,
                    double most_speed, double dt, Belief& b) noexcept {
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kFlexibleNoiseStep)));
  const double h = dt / steps;
  int blows = 0;
  for (int i = 0; i < steps && std::abs(b.state.speed) < most_speed; ++i) {
    const BlowPrior prior = b.priorOf(drawn);
    FlexibleMatrix f = FlexibleMatrix::Identity();
    const bool struck = advanceFlexible(model, h, {prior.mean, contact}, b.state, &f) > 0;
    if (struck) {
      if (!b.tool_met) b.drawFactor(prior);
      blows += !b.tool_met;
      b.tool_met = false;
    }
    apply(f, b);
    addNoise(walks, lawOf(*model.coupling(), b.state), h, b);
  }
  return blows;
}

void passLateFlexible(const ShaftModel& model, double factor, Belief& b) noexcept {
  FlexibleMatrix f = FlexibleMatrix::Identity();
  passBlowFlexible(model, factor, b.state, &f);
  apply(f, b);
}

void correctFlexible(FlexibleRow row, double innovation, double variance, const ConstantErrors::Row& measured_by_error,
                     Belief& b) noexcept {
  const FlexibleMatrix p = joint(b);
  const FlexibleVector gain = p.col(row) / (p(row, row) + variance);
  const FlexibleVector change = gain * innovation;
  Belief::Vector crank = change.head<5>();
  crank[Belief::kInertia] = std::clamp(crank[Belief::kInertia], -kMostInertiaChange, kMostInertiaChange);
  b.move(crank);
  b.state.twist += change[kMotorAngle] - change[Belief::kAngle];
  b.state.motor_speed += change[kMotorSpeed];
  b.state.log_stiffness += std::clamp(change[kStiffness], -kMostStiffnessChange, kMostStiffnessChange);
  b.state.log_stiffness = std::clamp(b.state.log_stiffness, -kMostLogStiffness, kMostLogStiffness);
  const Effect effect = jointEffect(b);
  setEffect(effect + gain * (measured_by_error - effect.row(row)), b);
  b.motor->by_odds -= gain * b.motor->by_odds[row];
  const FlexibleMatrix left = p - gain * p.row(row);  // Joseph form
  setJoint(left - left.col(row) * gain.transpose() + gain * (variance * gain.transpose()), b);
}

void widenFlexible(double factor, Belief& b) noexcept {
  FlexibleVector by = FlexibleVector::Constant(std::sqrt(factor));
  by[Belief::kInertia] = by[Belief::kFactor] = by[kStiffness] = by[kOdds] = 1.0;
  setJoint(by.asDiagonal() * joint(b) * by.asDiagonal(), b);
}

void forgetCouplingsOf(Belief& b) noexcept {
  Eigen::Matrix<double, 9, 4>& p = b.motor->covariance;
  const double variance = p(kStiffness, MotorSide::kStiffness);
  p.row(Belief::kInertia).setZero();
  p.row(kStiffness).setZero();
  p.col(MotorSide::kStiffness).setZero();
  p(kStiffness, MotorSide::kStiffness) = variance;
}

void doubtStiffness(const Coupling& coupling, Belief& b) noexcept {
  b.state.log_stiffness = 0.0;
  b.motor->covariance(kStiffness, MotorSide::kStiffness) = square(coupling.stiffness_deviation);
}

bool isSoundFlexible(double most_speed, const Belief& b) noexcept {
  return std::abs(b.state.motor_speed) < most_speed && std::abs(b.state.twist) < kMostTwist &&
         b.motor->covariance.allFinite() && (joint(b).diagonal().array() >= 0.0).all();
}

Eigen::Matrix3d flexibleMotionCovariance(const ShaftModel& model, const Belief& b, double growth,
                                         const ConstantErrors::Matrix& moment, double torque_part) noexcept {
  const AccelerationSlopes slopes = accelerationSlopes(model, b.state);
  Eigen::Matrix<double, 3, 9> jacobian = Eigen::Matrix<double, 3, 9>::Zero();
  jacobian(0, Belief::kAngle) = jacobian(1, Belief::kSpeed) = 1.0;
  jacobian.row(2) = slopes.others + slopes.by_moment;
  const Eigen::Matrix<double, 3, ConstantErrors::kSize> by_error = jacobian * jointEffect(b);
  const Eigen::Vector3d by_odds = jacobian * b.motor->by_odds;
  jacobian.row(2) = slopes.others + torque_part * slopes.by_moment;
  return growth * jacobian * joint(b) * jacobian.transpose() + by_error * moment * by_error.transpose() +
         b.motor->odds_variance * by_odds * by_odds.transpose();
}

}  // namespace hammer_loads
