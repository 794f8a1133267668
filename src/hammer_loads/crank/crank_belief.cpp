#include "hammer_loads/crank/crank_belief.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kLeastFactor = 0.01;  // factor of a blow; the crank is not thrown back
constexpr double kMostFactor = 4.0;
// Prior: kLeastFactor, kMostFactor

/// Adds the uncertainty of a relative change of speed w `since` [s] ago, whose instant is uncertain within dt [s].
void addSpeedChangeNoise(double variance, double w, double since, double dt, CrankBelief& b) noexcept {
  using B = CrankBelief;
  const double by_angle = w * since;
  b.addNoise(B::kAngle, B::kAngle, (square(by_angle) + square(w * dt) / 12.0) * variance);
  b.addNoise(B::kAngle, B::kSpeed, by_angle * w * variance);
  b.addNoise(B::kSpeed, B::kSpeed, square(w) * variance);
  b.addNoise(B::kAngle, B::kFactor, by_angle * variance);
  b.addNoise(B::kSpeed, B::kFactor, w * variance);
}

/// Returns true if the state is faster or further than any crank gets within the step.
bool hasDiverged(const BetweenSamples& s, const ShaftState& state) noexcept {
  return !(std::abs(state.speed) < s.most_speed &&
           std::abs(difference(state.position, s.before.state.position)) <= s.most_speed * s.step + 0.5 * kTwoPi);
}

/// Moves the position by `apart` [rad] from the forward path towards the backward one.
void move(double apart, const CrankPosition& back, CrankPosition& position) noexcept {
  if (position.angle.side == back.angle.side || position.isMirrored() || back.isMirrored()) {
    position.slide(apart);
  } else {
    position.turn(apart);
  }
}

/// Speed of a path on the relevant side of the blow, where the two paths pass it at different instants. A crank that
/// turns back makes no blow.
double speedOn(const CrankAngle& angle, const ShaftState& path, double factor, bool forward) noexcept {
  const double speed = path.speed;
  if (path.position.angle.side == angle.side || std::abs(angle.offset) > 1.0 || !(speed > 0.0) || !forward)
    return speed;
  return angle.side == Side::kAfterBlow ? speed * factor : speed / factor;
}

/// States of both paths after dt, at the place between them.
struct Paths {
  ShaftState forward, back;
  bool diverged{};  ///< true if one path has diverged and was replaced
};

Paths pathsAfter(const BetweenSamples& s, double dt) noexcept {
  const ShaftState &before = s.before.state, &now = s.now.state;
  Paths paths{before, now};
  const bool contact = !before.position.isMirrored() && !now.position.isMirrored();
  // A tool met before the dead centre leaves nothing to strike there, unless that turned out to be a blow.
  const bool tool_was_none = s.before.struck_early && !s.now.struck_early;
  const Passing passing{s.before.tool_met && !tool_was_none ? 1.0 : s.now.factor, contact};
  advanceState(s.step_model, dt, passing, paths.forward);
  const double part = dt / s.step;
  if (hasDiverged(s, paths.forward)) {
    paths.diverged = true;
    paths.forward = before;
    paths.forward.position.turn(part * difference(now.position, before.position));
  }
  const bool at_begin = !(part > 0.0);  // there the backward path has no weight
  if (!at_begin) advanceState(s.step_model, dt - s.step, passing, paths.back);
  const bool back_diverged = !at_begin && hasDiverged(s, paths.back);
  paths.diverged |= back_diverged;
  if (at_begin || back_diverged) paths.back = paths.forward;
  CrankPosition position = paths.forward.position;
  move(part * difference(paths.back.position, paths.forward.position), paths.back.position, position);
  const bool forward = now.position.blowsPassed() >= before.position.blowsPassed();
  for (ShaftState* path : {&paths.forward, &paths.back}) {
    path->speed = speedOn(position.angle, *path, passing.factor, forward);
    path->position = position;
  }
  return paths;
}

/// Returns the estimate at the place between both samples, with the hull's motion there.
CrankEstimate estimateThere(const BetweenSamples& s, double dt, const ShaftState& state) noexcept {
  ShaftModel there = s.model;
  there.setHullMotion(blend(s.before_hull, s.now_hull, dt / s.step));
  return estimateOf(there(state.position.angle), state);
}

}  // namespace

void CrankBelief::drawFactor(const BlowPrior& prior) noexcept {
  factor = prior.mean;
  struck_early = false;
  draw(kFactor, square(prior.deviation), prior.by_error);
}

BlowPrior CrankBelief::priorOf(const BlowPrior& drawn) const noexcept { return tool_met ? BlowPrior{1.0, 0.0} : drawn; }

void CrankBelief::widen(double by) noexcept {
  if (!(by > 1.0)) return;
  const double root = std::sqrt(by);
  Vector deviations;
  deviations << root, root, root, 1.0, 1.0;
  Base::widen(deviations);
}

int CrankBelief::predict(const ShaftModel& model, ShaftLoad load, const CrankWalks& walks, const BlowPrior& drawn,
                         bool contact, double most_speed, double dt) noexcept {
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
    const ConstantErrors::Row torque_by_constant = 0.5F * ConstantErrors::ofTorque(supply, lead);
    by_constant.row(kTorque) += torque_by_constant;
    Base::predict<kAngle, kSpeed>(step.transition);
    by_constant.row(kTorque) += torque_by_constant;
    if (columns) {
      const double drive = state.torque - state.drive_inertia * load.hull_acceleration;
      const ColumnStep::Columns of_speed =
          columns->ofSpeed(model, state, state.drive_inertia, load, drive, h, step.blows > 0);
      constexpr int kFirst = ConstantErrors::kTable;
      by_constant.row(kSpeed).middleCols<kMachineColumns>(kFirst) += of_speed;
      by_constant.row(kAngle).middleCols<kMachineColumns>(kFirst) +=
          static_cast<float>(0.5 * h) * of_speed;  // even change of speed
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
  addSpeedChangeNoise(square(deviation), state.speed, 0.5 * dt, dt, *this);
}

bool CrankBelief::inflateBlow(Row row, double innovation, double total, double dt) noexcept {
  const double before = state.speed / factor, since = std::max(0.5 * dt, state.position.angle.offset / state.speed);
  const double squared = row == kSpeed ? square(before) : square(before) * (square(since) + square(dt) / 12.0);
  const double variance = (square(innovation) - total) / squared;
  if (!(variance > 0.0)) return false;
  covariance(kFactor, kFactor) += variance;
  struck_early = struck_early && square(factor - 1.0) > variance;  // otherwise the early contact was noise
  addSpeedChangeNoise(variance, before, since, dt, *this);
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
  result.by_constant.row(CrankUncertainty::kAcceleration).middleCols<kMachineColumns>(ConstantErrors::kTable) +=
      static_cast<float>(inverse_inertia) *
      (on_shaft.row(2) - static_cast<float>(square(belief.state.speed)) * on_shaft.row(1) -
       static_cast<float>(acceleration) * on_shaft.row(0));
}

/// Linearised in the state's error; the acceleration's derivative by the angle is a difference quotient.
CrankUncertainty motionUncertainty(const ShaftModel& model, const ShaftLoad& load, const CrankBelief& belief,
                                   double growth, const ConstantErrors::Matrix& root, double torque_part) noexcept {
  const ShaftState& state = belief.state;
  const double inv = 1.0 / (state.drive_inertia + load.inertia), here = acceleration(load, state);
  constexpr double kStep = 1e-6;  // [rad]: relative errors 1e-6 by curvature and 1e-9 by rounding
  // Numerical: kStep
  CrankAngle stepped = state.position.angle;
  stepped.offset += kStep;
  Eigen::RowVector4d by;  // the acceleration's derivatives
  by[CrankBelief::kAngle] = (acceleration(model(stepped), state) - here) / kStep;
  by[CrankBelief::kSpeed] = -2.0 * load.half_inertia_slope * state.speed * inv;
  by[CrankBelief::kTorque] = inv * torque_part;
  by[CrankBelief::kInertia] = -(here + load.hull_acceleration) * state.drive_inertia * inv;
  const ShaftMatrix& P = belief.covariance;
  const Eigen::RowVector4d with = by.lazyProduct(P.topLeftCorner<4, 4>());  // covariances of the acceleration
  CrankUncertainty result;
  result.own << P.topLeftCorner<2, 2>(), with.head<2>().transpose(), with.head<2>(), with.dot(by);
  result.own *= growth;
  result.by_constant.topRows<2>() = belief.by_constant.topRows<2>();
  result.by_constant.row(CrankUncertainty::kAcceleration) =
      by.cast<float>().lazyProduct(belief.by_constant.topRows<4>());
  result.by_constant.row(CrankUncertainty::kInertia) = belief.by_constant.row(CrankBelief::kInertia);
  ConstantErrors::toColumns(root, result.by_constant);
  addAcceleration(model, belief, here, inv, result);
  result.inertia = std::sqrt(growth * P(CrankBelief::kInertia, CrankBelief::kInertia));
  return result;
}

CrankEstimate estimateBetween(const BetweenSamples& s, double dt) noexcept {
  const auto [forward, back, diverged] = pathsAfter(s, dt);
  const double part = dt / s.step;
  ShaftState state = forward;
  state.speed += part * (back.speed - state.speed);
  state.torque += part * (back.torque - state.torque);
  state.drive_inertia += part * (back.drive_inertia - state.drive_inertia);
  return estimateThere(s, dt, state);
}

std::optional<CrankPaths> pathsBetween(const BetweenSamples& s, double dt) noexcept {
  const Paths paths = pathsAfter(s, dt);
  if (paths.diverged) return std::nullopt;
  return CrankPaths{estimateThere(s, dt, paths.forward), estimateThere(s, dt, paths.back)};
}

}  // namespace hammer_loads
