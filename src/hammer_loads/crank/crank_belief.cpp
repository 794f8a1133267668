#include "hammer_loads/crank/crank_belief.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/column_step.h"
#include "hammer_loads/util/growth.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kLeastFactor = 0.01;  // of a blow; the crank is not thrown back
constexpr double kMostFactor = 4.0;
// Prior: kLeastFactor, kMostFactor
constexpr double kMostDoubt = 1.0;     // deviation of a blow's factor: those of restitution 0 to 0.3 differ by 0.6
constexpr double kTightFactor = 0.02;  // deviation at a dead centre where nothing strikes any more

/// The speed w changed by a part of that variance, `since` ago [s]; the instant may be any within dt [s].
void doubtSpeedChange(double variance, double w, double since, double dt, CrankBelief& b) noexcept {
  using B = CrankBelief;
  const double by_angle = w * since;
  b.addNoise(B::kAngle, B::kAngle, (square(by_angle) + square(w * dt) / 12.0) * variance);
  b.addNoise(B::kAngle, B::kSpeed, by_angle * w * variance);
  b.addNoise(B::kSpeed, B::kSpeed, square(w) * variance);
  b.addNoise(B::kAngle, B::kFactor, by_angle * variance);
  b.addNoise(B::kSpeed, B::kFactor, w * variance);
}

}  // namespace

void CrankBelief::drawFactor(const BlowPrior& prior) noexcept {
  factor = prior.mean;
  struck_early = false;
  draw(kFactor, square(prior.deviation), prior.by_error);
}

BlowPrior CrankBelief::priorOf(const BlowPrior& drawn) const noexcept {
  return tool_met ? BlowPrior{1.0, kTightFactor} : drawn;
}

void CrankBelief::widen(double by) noexcept {
  if (!(by > 1.0)) return;
  const double root = std::sqrt(by);
  Vector deviations;
  deviations << root, root, root, 1.0, 1.0;
  Base::widen(deviations);
}

int CrankBelief::predict(const ShaftModel& model, const CrankWalks& walks, const BlowPrior& drawn, bool contact,
                         double most_speed, double dt) noexcept {
  ShaftLoad load = model(state.position.angle);
  const int steps = std::max(1, static_cast<int>(std::ceil(dt / kNoiseStep)));
  const double h = dt / steps;
  const SupplyLaw& supply = walks.supply;
  const double torque = square(walks.torque) * h, speed = square(walks.speed) * h;
  int blows = 0;
  for (int i = 0; i < steps && std::abs(state.speed) < most_speed; ++i) {
    const double b = 1.0 / (state.drive_inertia + load.inertia);
    const BlowPrior prior = priorOf(drawn);
    const double torque_before = state.torque;
    const CrankPosition from = state.position;
    std::optional<ColumnStep> columns;
    if (!model.isExact()) columns.emplace(model, state, state.drive_inertia, load);
    state.torque -= 0.5 * supply.stiffness * supply.lead(state.speed * h, h);  // mean of the step
    const Advance step = advance(model, h, {prior.mean, contact}, state, load);
    const double lead = supply.lead(difference(state.position, from), h);
    state.torque = torque_before - supply.stiffness * lead;
    if (step.blows > 0) {
      if (!tool_met) drawFactor(prior);
      blows += !tool_met;
      tool_met = false;
    }
    const ConstantErrors::Row torque_by_constant = 0.5 * ConstantErrors::ofTorque(supply, lead);
    by_constant.row(kTorque) += torque_by_constant;
    Base::predict<kAngle, kSpeed>(step.transition);
    by_constant.row(kTorque) += torque_by_constant;
    if (columns) {
      const double drive = state.torque - state.drive_inertia * load.hull_acceleration;
      addWithin<kAngle, kSpeed>(columns->ofSpeed(model, state, state.drive_inertia, load, drive, h, step.blows > 0), h,
                                by_constant);
    }
    addNoise(kAngle, kAngle, speed * h * h / 3.0);
    addNoise(kSpeed, kSpeed, speed + torque * square(b * h) / 3.0);
    addNoise(kTorque, kTorque, torque);
    addNoise(kInertia, kInertia, square(walks.inertia) * h);
    addNoise(kAngle, kSpeed, 0.5 * speed * h);
    addNoise(kSpeed, kTorque, 0.5 * torque * b * h);
  }
  return blows;
}

void CrankBelief::move(const Vector& change) noexcept {
  state.position.slide(change[kAngle]);
  state.speed += change[kSpeed];
  state.torque += change[kTorque];
  state.drive_inertia = std::clamp(state.drive_inertia * growth(change[kInertia]), least_inertia, most_inertia);
  factor += change[kFactor];
}

void CrankBelief::boundFactor() noexcept {
  const double bounded = std::clamp(factor, kLeastFactor, kMostFactor), variance = covariance(kFactor, kFactor);
  if (bounded != factor && variance > 0.0) move((bounded - factor) / variance * covariance.col(kFactor));
  factor = bounded;
}

void CrankBelief::correct(Row row, double innovation, double variance, const ConstantErrors::Row& by_error,
                          const std::optional<ConstantErrors::Row>& of_constants) noexcept {
  Vector change = Base::correct(row, variance, by_error, of_constants) * innovation;
  change[kInertia] = std::clamp(change[kInertia], -kMostInertiaChange, kMostInertiaChange);
  move(change);
}

void CrankBelief::forgetInertiaCoupling() noexcept { decouple(kInertia); }

void CrankBelief::forgetAngle(double variance) noexcept { forget(kAngle, variance); }

void CrankBelief::passLate(const ShaftModel& model, const BlowPrior& drawn) noexcept {
  const BlowPrior prior = priorOf(drawn);
  if (!tool_met && state.speed > 0.0) drawFactor(prior);
  tool_met = false;
  ShaftTransition f = ShaftTransition::Identity();
  ShaftLoad load;
  passBlow(model, prior.mean, state, load, f);
  Base::predict<kAngle, kSpeed>(f);
}

void CrankBelief::meetTool(double deviation, double dt) noexcept {
  drawFactor({1.0, deviation});
  doubtSpeedChange(square(deviation), state.speed, 0.5 * dt, dt, *this);
}

bool CrankBelief::doubtBlow(Row row, double innovation, double total, double dt) noexcept {
  const double before = state.speed / factor, since = std::max(0.5 * dt, state.position.angle.offset / state.speed);
  const double squared = row == kSpeed ? square(before) : square(before) * (square(since) + square(dt) / 12.0);
  const double variance = (square(innovation) - total) / squared;
  if (!(variance > 0.0 && variance < square(kMostDoubt))) return false;
  covariance(kFactor, kFactor) += variance;
  struck_early = struck_early && square(factor - 1.0) > variance;  // else what was taken for the tool was noise
  doubtSpeedChange(variance, before, since, dt, *this);
  return true;
}

BlowFactor CrankBelief::blowFactor(double growth, const ConstantErrors::Matrix& root) const noexcept {
  const double of_factor = std::sqrt(growth * covariance(kFactor, kFactor)),
               of_inertia = std::sqrt(growth * covariance(kInertia, kInertia));
  ByConstants<2, ConstantErrors::kSize> by;
  by << by_constant.row(kFactor), by_constant.row(kInertia);
  ConstantErrors::toColumns(root, by);
  return {factor, of_factor, state.drive_inertia, of_inertia, struck_early, by};
}

bool CrankBelief::isSound(double most_speed) const noexcept {
  return std::abs(state.position.angle.offset) <= 0.5 * kTwoPi && std::abs(state.speed) < most_speed &&
         std::isfinite(state.torque) && std::isfinite(state.drive_inertia) && std::isfinite(factor) && Base::isSound();
}

void addAcceleration(const ShaftModel& model, const CrankBelief& belief, double acceleration, double inverse_inertia,
                     CrankUncertainty& result) noexcept {
  if (model.isExact()) return;
  const MachineColumns::OnShaft on_shaft = model.columns(belief.state.position.angle);
  result.by_constant.row(CrankUncertainty::kAcceleration).tail<kMachineColumns>() +=
      inverse_inertia *
      (on_shaft.row(2) - square(belief.state.speed) * on_shaft.row(1) - acceleration * on_shaft.row(0));
}

/// Linear in the state's deviation; the acceleration's derivative by the angle by a difference.
CrankUncertainty motionUncertainty(const ShaftModel& model, const ShaftLoad& load, const CrankBelief& belief,
                                   double growth, const ConstantErrors::Matrix& root, double torque_part) noexcept {
  const ShaftState& state = belief.state;
  const double inv = 1.0 / (state.drive_inertia + load.inertia), here = acceleration(load, state);
  constexpr double kStep = 1e-6;  // [rad]: error 1e-6 by curvature, 1e-9 by rounding, both relative
  // Numerical: kStep
  CrankAngle beside = state.position.angle;
  beside.offset += kStep;
  Eigen::RowVector4d by;  // the acceleration's derivatives
  by[CrankBelief::kAngle] = (acceleration(model(beside), state) - here) / kStep;
  by[CrankBelief::kSpeed] = -2.0 * load.half_inertia_slope * state.speed * inv;
  by[CrankBelief::kTorque] = inv * torque_part;
  by[CrankBelief::kInertia] = -(here + load.hull_acceleration) * state.drive_inertia * inv;
  const ShaftMatrix& P = belief.covariance;
  const Eigen::RowVector4d with = by.lazyProduct(P.topLeftCorner<4, 4>());  // covariances of the acceleration
  CrankUncertainty result;
  result.own << P.topLeftCorner<2, 2>(), with.head<2>().transpose(), with.head<2>(), with.dot(by);
  result.own *= growth;
  result.by_constant.topRows<2>() = belief.by_constant.topRows<2>();
  result.by_constant.row(CrankUncertainty::kAcceleration) = by.lazyProduct(belief.by_constant.topRows<4>());
  result.by_constant.row(CrankUncertainty::kInertia) = belief.by_constant.row(CrankBelief::kInertia);
  ConstantErrors::toColumns(root, result.by_constant);
  addAcceleration(model, belief, here, inv, result);
  result.inertia = std::sqrt(growth * P(CrankBelief::kInertia, CrankBelief::kInertia));
  return result;
}

}  // namespace hammer_loads
