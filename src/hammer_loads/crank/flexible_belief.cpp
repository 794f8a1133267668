#include "hammer_loads/crank/flexible_belief.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/crank/column_step.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;
using Joint = FlexibleVariables;

constexpr double kMostStiffnessChange = 0.1;  // of a logarithm by one sample
constexpr double kMostLogStiffness = 1.4;     // a factor of two of the frequency either way
// Guard: FlexibleBounds.OfTheCouplingsStiffness of kMostStiffnessChange
// Prior: FlexibleBounds.OfTheCouplingsStiffness of kMostLogStiffness
constexpr double kMostTwist = 1.0;  // [rad]: more is a diverged filter
// Guard: FlexibleBounds.OfTheTwist of kMostTwist

/// f: with columns for odds and damping, errors of which act within the step.
void apply(const FlexibleMatrix& f, Joint& all) noexcept {
  Joint::Effect step = Joint::Effect::Zero();
  step.col(ConstantErrors::kShare) = f.col(kOdds).head<kFlexibleVariables>();
  step.col(ConstantErrors::kDamping) = f.col(kDamping).head<kFlexibleVariables>();
  all.predict(f.topLeftCorner<kFlexibleVariables, kFlexibleVariables>(), step);
}

/// On the crank acts the coupling's moment.
void endColumns(const ShaftModel& model, const ShaftState& to, double h, bool struck, ColumnStep& columns,
                Joint& all) noexcept {
  const CouplingLaw law = lawOf(*model.coupling(), to);
  const ShaftLoad load = model(to.position.angle);
  const double moment = law.moment(to.twist, to.motor_speed, to.speed) - law.crank_inertia * load.hull_acceleration;
  addWithin<Belief::kAngle, Belief::kSpeed>(columns.ofSpeed(model, to, law.crank_inertia, load, moment, h, struck), h,
                                            all.by_constant);
}

/// speed: of crank and motor together; torque: of the motor.
void addNoise(const CrankWalks& walks, const CouplingLaw& law, double h, Joint& all) noexcept {
  const double torque = square(walks.torque) * h, speed = square(walks.speed) * h, by_torque = h / law.motor_inertia;
  for (const auto& [angle, rate] :
       {std::pair<Eigen::Index, Eigen::Index>{Belief::kAngle, Belief::kSpeed}, {kMotorAngle, kMotorSpeed}}) {
    all.addNoise(angle, angle, speed * h * h / 3.0);
    all.addNoise(rate, rate, speed);
    all.addNoise(angle, rate, 0.5 * speed * h);
  }
  all.addNoise(Belief::kAngle, kMotorAngle, speed * h * h / 3.0);
  all.addNoise(Belief::kSpeed, kMotorSpeed, speed);
  all.addNoise(Belief::kAngle, kMotorSpeed, 0.5 * speed * h);
  all.addNoise(Belief::kSpeed, kMotorAngle, 0.5 * speed * h);
  all.addNoise(kMotorSpeed, kMotorSpeed, torque * square(by_torque) / 3.0);
  all.addNoise(Belief::kTorque, kMotorSpeed, 0.5 * torque * by_torque);
  all.addNoise(Belief::kTorque, Belief::kTorque, torque);
  all.addNoise(Belief::kInertia, Belief::kInertia, square(walks.inertia) * h);
}

/// Derivatives of the crank's acceleration: by the coupling's moment times those of the moment, and all others.
struct AccelerationSlopes {
  using Row = Eigen::Matrix<double, 1, FlexibleMatrix::ColsAtCompileTime>;
  Row by_moment{Row::Zero()}, others{by_moment};
};

AccelerationSlopes accelerationSlopes(const ShaftModel& model, const ShaftState& state) noexcept {
  constexpr double kStep = 1e-5;  // [rad]
  // Numerical: kStep
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
  s.others[kDamping] = slip * inv;
  return s;
}

/// transition: null, or extended by f, in which a factor that is drawn anew has no past.
void extend(const FlexibleMatrix& f, bool drawn, FlexibleMatrix* transition) noexcept {
  if (transition == nullptr) return;
  if (drawn) transition->row(Belief::kFactor).setZero();
  *transition = (f * *transition).eval();
}

}  // namespace

FlexibleVariables variablesOf(const CrankBelief& b) noexcept {
  FlexibleVariables all;
  all.covariance.topLeftCorner<5, 5>() = b.covariance;
  all.covariance.rightCols<3>() = b.motor->covariance;
  all.covariance.bottomLeftCorner<3, 5>() = b.motor->covariance.topRows<5>().transpose();
  all.by_constant << b.by_constant, b.motor->by_constant;
  return all;
}

void setVariables(const FlexibleVariables& all, CrankBelief& b) noexcept {
  b.covariance = all.covariance.topLeftCorner<5, 5>();
  b.motor->covariance = all.covariance.rightCols<3>();
  b.by_constant = all.by_constant.topRows<5>();
  b.motor->by_constant = all.by_constant.bottomRows<3>();
}

void moveFlexible(const FlexibleVariables::Vector& change, CrankBelief& b) noexcept {
  b.move(change.head<5>());
  b.state.twist += change[kMotorAngle] - change[Belief::kAngle];
  b.state.motor_speed += change[kMotorSpeed];
  b.state.log_stiffness = std::clamp(b.state.log_stiffness + change[kStiffness], -kMostLogStiffness, kMostLogStiffness);
}

void beginMotor(const Coupling& coupling, double torque_deviation, Belief& b) noexcept {
  const double stiffness_variance =
      b.motor ? b.motor->covariance(kStiffness, MotorSide::kStiffness) : square(coupling.stiffness_deviation);
  b.state.twist = 0.0;
  b.state.motor_speed = b.state.speed;
  b.motor.emplace();
  MotorSide& m = *b.motor;
  m.covariance(Belief::kAngle, MotorSide::kAngle) = m.covariance(kMotorAngle, MotorSide::kAngle) =
      b.covariance(Belief::kAngle, Belief::kAngle);
  m.covariance(Belief::kSpeed, MotorSide::kSpeed) = m.covariance(kMotorSpeed, MotorSide::kSpeed) =
      b.covariance(Belief::kSpeed, Belief::kSpeed);
  m.covariance(kStiffness, MotorSide::kStiffness) = stiffness_variance;
  m.by_constant.topRows<2>() = b.by_constant.topRows<2>();
  const CouplingLaw law = lawOf(coupling, b.state);
  const double twist = torque_deviation / law.stiffness;
  b.covariance(Belief::kAngle, Belief::kAngle) += square(twist);
  b.covariance(Belief::kSpeed, Belief::kSpeed) += square(2.0 * kPi * coupling.frequency * twist);
}

int predictFlexible(const ShaftModel& model, const CrankWalks& walks, const BlowPrior& drawn, bool contact,
                    double most_speed, double dt, Belief& b, FlexibleMatrix* transition) noexcept {
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kNoiseStep)));
  const double h = dt / steps;
  Joint all = variablesOf(b);
  int blows = 0;
  for (int i = 0; i < steps && std::abs(b.state.speed) < most_speed; ++i) {
    const BlowPrior prior = b.priorOf(drawn);
    std::optional<ColumnStep> columns;
    if (!model.isExact())
      columns.emplace(model, b.state, lawOf(*model.coupling(), b.state).crank_inertia, model(b.state.position.angle),
                      b.near);
    FlexibleMatrix f = FlexibleMatrix::Identity();
    const bool struck = advanceFlexible(model, h, {prior.mean, contact}, b.state, &f) > 0;
    const bool draws = struck && !b.tool_met;
    if (struck) {
      if (draws) {
        b.drawFactor(prior);
        all.draw(Belief::kFactor, b.covariance(Belief::kFactor, Belief::kFactor), b.by_constant.row(Belief::kFactor));
      }
      blows += draws;
      b.tool_met = false;
    }
    apply(f, all);
    extend(f, draws, transition);
    if (columns) endColumns(model, b.state, h, struck, *columns, all);
    addNoise(walks, lawOf(*model.coupling(), b.state), h, all);
  }
  setVariables(all, b);
  return blows;
}

void passLateFlexible(const ShaftModel& model, double factor, bool drawn, Belief& b,
                      FlexibleMatrix* transition) noexcept {
  FlexibleMatrix f = FlexibleMatrix::Identity();
  passBlowFlexible(model, factor, b.state, &f);
  extend(f, drawn, transition);
  Joint all = variablesOf(b);
  apply(f, all);
  setVariables(all, b);
}

void correctFlexible(FlexibleRow row, double innovation, double variance, const ConstantErrors::Row& by_error,
                     const std::optional<ConstantErrors::Row>& of_constants, Belief& b) noexcept {
  Joint all = variablesOf(b);
  Joint::Vector change = all.correct(row, variance, by_error, of_constants) * innovation;
  setVariables(all, b);
  change[Belief::kInertia] = std::clamp(change[Belief::kInertia], -kMostInertiaChange, kMostInertiaChange);
  change[kStiffness] = std::clamp(change[kStiffness], -kMostStiffnessChange, kMostStiffnessChange);
  moveFlexible(change, b);
}

void widenFlexible(double factor, Belief& b) noexcept {
  Joint::Vector by = Joint::Vector::Constant(std::sqrt(factor));
  by[Belief::kInertia] = by[Belief::kFactor] = by[kStiffness] = 1.0;
  Joint all = variablesOf(b);
  all.widen(by);
  setVariables(all, b);
}

void forgetAngleFlexible(double variance, Belief& b) noexcept {
  Joint all = variablesOf(b);
  all.forget(kMotorAngle, variance);
  all.covariance(Belief::kAngle, kMotorAngle) = all.covariance(kMotorAngle, Belief::kAngle) = variance;
  setVariables(all, b);
}

void forgetCouplingsOf(Belief& b) noexcept {
  Joint all = variablesOf(b);
  all.decouple(Belief::kInertia);
  all.decouple(kStiffness);
  setVariables(all, b);
}

void doubtStiffness(const Coupling& coupling, Belief& b) noexcept {
  b.state.log_stiffness = 0.0;
  b.motor->covariance(kStiffness, MotorSide::kStiffness) = square(coupling.stiffness_deviation);
}

bool isSoundFlexible(double most_speed, const Belief& b) noexcept {
  return std::abs(b.state.motor_speed) < most_speed && std::abs(b.state.twist) < kMostTwist && variablesOf(b).isSound();
}

CrankUncertainty flexibleUncertainty(const ShaftModel& model, const Belief& b, double growth,
                                     const ConstantErrors::Matrix& root, double torque_part) noexcept {
  const AccelerationSlopes slopes = accelerationSlopes(model, b.state);
  const Joint all = variablesOf(b);
  Eigen::Matrix<double, 4, kFlexibleVariables> jacobian = Eigen::Matrix<double, 4, kFlexibleVariables>::Zero();
  jacobian(0, Belief::kAngle) = jacobian(1, Belief::kSpeed) = jacobian(3, Belief::kInertia) = 1.0;
  jacobian.row(2) = (slopes.others + slopes.by_moment).head<kFlexibleVariables>();
  CrankUncertainty result;
  result.by_constant = jacobian * all.by_constant;
  result.by_constant(2, ConstantErrors::kShare) += slopes.others[kOdds];
  result.by_constant(2, ConstantErrors::kDamping) += slopes.others[kDamping];
  ConstantErrors::toColumns(root, result.by_constant);
  const ShaftLoad load = model(b.state.position.angle);
  const double inv = 1.0 / (lawOf(*model.coupling(), b.state).crank_inertia + load.inertia);
  addAcceleration(model, b, acceleration(model, load, b.state), inv, result);
  jacobian.row(2) = (slopes.others + torque_part * slopes.by_moment).head<kFlexibleVariables>();
  result.own = growth * jacobian.topRows<3>() * all.covariance * jacobian.topRows<3>().transpose();
  result.inertia = std::sqrt(growth * all.covariance(Belief::kInertia, Belief::kInertia));
  return result;
}

}  // namespace hammer_loads
