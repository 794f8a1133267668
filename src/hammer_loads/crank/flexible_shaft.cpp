#include "hammer_loads/crank/flexible_shaft.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/flexible_rates.h"

namespace hammer_loads {
namespace {

constexpr double kMaxStepPhase = 0.4;  // [rad] of the coupling's oscillation
// Guard: FlexibleShaft.ItsLinearisationFollowsFiniteDifferences of kMaxStepPhase

/// Of one smooth piece: exponential of the mean of both ends' linearisations, to fourth order.
FlexibleMatrix transition(const FlexibleShaft& s, double dt, const FlexiblePath& start, const ShaftLoad& load,
                          const FlexiblePath& end, const ShaftLoad& load_end) noexcept {
  const LinearisedFlexible p = linearised(s, start, load), q = linearised(s, end, load_end);
  const FlexiblePathMatrix a = 0.5 * dt * (p.by_path + q.by_path), square = a * a;
  const FlexiblePathMatrix mean = FlexiblePathMatrix::Identity() + 0.5 * a + square / 6.0 + square * a / 24.0;
  FlexiblePathMatrix by_path = FlexiblePathMatrix::Identity() + a * mean;
  InputMatrix by_input = mean * (0.5 * dt * (p.by_input + q.by_input));
  // from h to the speed, at both ends
  const double inertia = s.law.crank_inertia,
               by_odds = -inertia * s.law.motor_inertia / (inertia + s.law.motor_inertia);
  const double root = std::sqrt(inertia + load.inertia), root_end = std::sqrt(inertia + load_end.inertia);
  const double speed = start[kPathH] / root, speed_end = end[kPathH] / root_end;
  by_input.col(1) += 0.5 * speed * inertia / root * by_path.col(kPathH);
  by_input.col(3) += 0.5 * speed * by_odds / root * by_path.col(kPathH);
  by_path.col(kPathOffset) += speed * load.half_inertia_slope / root * by_path.col(kPathH);
  by_path.col(kPathH) *= root;
  const double by_angle = speed_end * load_end.half_inertia_slope / root_end;
  by_input(kPathH, 1) -= 0.5 * speed_end * inertia / root_end;
  by_input(kPathH, 3) -= 0.5 * speed_end * by_odds / root_end;
  by_input.row(kPathH) = ((by_input.row(kPathH) - by_angle * by_input.row(kPathOffset)) / root_end).eval();
  by_path.row(kPathH) = ((by_path.row(kPathH) - by_angle * by_path.row(kPathOffset)) / root_end).eval();
  constexpr Eigen::Index rows[] = {0, 1, kMotorAngle, kMotorSpeed}, inputs[] = {2, 3, kStiffness, kOdds, kDamping};
  FlexibleMatrix f = FlexibleMatrix::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) f(rows[i], rows[k]) = by_path(i, k);
    for (int k = 0; k < 5; ++k) f(rows[i], inputs[k]) = by_input(i, k);
  }
  return f;
}

/// One smooth piece of the way, ending at dt or at the blow.
WayPiece advancePiece(const ShaftModel& model, double dt, bool contact, ShaftState& state,
                      FlexibleMatrix* total) noexcept {
  const FlexibleShaft shaft{model, lawOf(*model.coupling(), state), state.position.angle.side, state.torque};
  const auto load_at = [&](const CrankAngle& angle) { return total ? model(angle) : model.withoutSlopes(angle); };
  const ShaftLoad load = load_at(state.position.angle);
  const FlexiblePath start{state.position.angle.offset, std::sqrt(shaft.law.crank_inertia + load.inertia) * state.speed,
                           state.twist, state.motor_speed};
  const FlexiblePath first = shaft.rate(start, load);
  FlexiblePath end = shaft.after(start, first, dt);
  const bool forward = (shaft.side == Side::kBeforeBlow) == (dt > 0.0);  // not falling back onto the tool
  WayPiece piece{
      dt, (contact || !forward) && isBeyond(shaft.side, end[kPathOffset]) && !isBeyond(shaft.side, start[kPathOffset])};
  if (piece.at_blow) {
    piece.used = timeToBlow([&](double t) { return shaft.after(start, first, t)[kPathOffset]; }, start[kPathOffset],
                            end[kPathOffset], dt);
    end = shaft.after(start, first, piece.used);
    end[kPathOffset] = 0.0;
  }
  const ShaftLoad load_end = load_at({end[kPathOffset], shaft.side});
  if (total != nullptr) *total = (transition(shaft, piece.used, start, load, end, load_end) * *total).eval();
  state.position.angle.offset = end[kPathOffset];
  state.position.renormalise();
  state.speed = end[kPathH] / std::sqrt(shaft.law.crank_inertia + load_end.inertia);
  state.twist = end[kPathTwist];
  state.motor_speed = end[kPathMotor];
  return piece;
}

}  // namespace

LinearisedFlexible linearised(const FlexibleShaft& s, const FlexiblePath& at, const ShaftLoad& load) noexcept {
  const CouplingLaw& c = s.law;
  const double inv = 1.0 / (c.crank_inertia + load.inertia), inv_root = std::sqrt(inv), speed = at[kPathH] * inv_root;
  const double slip = c.damping * (at[kPathMotor] - speed), spring = c.stiffness * at[kPathTwist];
  const double torque = spring + slip + load.weight_torque - c.crank_inertia * load.hull_acceleration;
  const double speed_by_angle = -speed * load.half_inertia_slope * inv;
  const double per_motor = 1.0 / c.motor_inertia, moment_by_angle = -c.stiffness - c.damping * speed_by_angle;
  LinearisedFlexible d;
  d.by_path << speed_by_angle, inv_root, 0.0, 0.0,  //
      (moment_by_angle + load.weight_torque_slope - torque * load.half_inertia_slope * inv) * inv_root,
      -c.damping * inv, c.stiffness * inv_root, c.damping * inv_root,  //
      0.0, 0.0, 0.0, 1.0,                                              //
      -moment_by_angle * per_motor, c.damping * inv_root * per_motor, -c.stiffness * per_motor, -c.damping * per_motor;
  // By something that changes both inertias and the moment at given twist and speeds.
  const auto by = [&](double crank, double motor, double moment) {
    const double speed_by = -0.5 * speed * crank * inv, moment_by = moment - c.damping * speed_by;
    return FlexiblePath(speed_by, (moment_by - crank * load.hull_acceleration - 0.5 * torque * crank * inv) * inv_root,
                        0.0, -(moment_by + (s.torque - spring - slip) * motor * per_motor) * per_motor);
  };
  const double on_crank = c.crank_inertia / (c.crank_inertia + c.motor_inertia), odds = on_crank * c.motor_inertia;
  d.by_input.col(0) << 0.0, 0.0, 0.0, per_motor;
  d.by_input.col(1) = by(c.crank_inertia, c.motor_inertia, spring + slip);
  d.by_input.col(2) = by(0.0, 0.0, spring + 0.5 * slip);
  d.by_input.col(3) = by(-odds, odds, (2.0 * on_crank - 1.0) * (spring + slip));
  d.by_input.col(4) = by(0.0, 0.0, slip);
  return d;
}

CouplingLaw lawOf(const Coupling& coupling, const ShaftState& state) noexcept {
  return {coupling, state.drive_inertia, state.log_stiffness, state.log_odds};
}

double flexibleAcceleration(const Coupling& coupling, const ShaftLoad& load, const ShaftState& s) noexcept {
  const CouplingLaw law = lawOf(coupling, s);
  return (law.moment(s.twist, s.motor_speed, s.speed) + load.weight_torque -
          law.crank_inertia * load.hull_acceleration - load.half_inertia_slope * s.speed * s.speed) /
         (law.crank_inertia + load.inertia);
}

CrankEstimate flexibleEstimate(const Coupling& coupling, const ShaftLoad& load, const ShaftState& s) noexcept {
  const CouplingLaw law = lawOf(coupling, s);
  const double e = flexibleAcceleration(coupling, load, s), motor = motorAcceleration(coupling, load, s);
  const double share = law.motor_inertia / (law.motor_inertia + law.crank_inertia);
  return {s.position, s.speed, e, share * (s.motor_speed - s.speed), share * (motor - e)};
}

double motorAcceleration(const Coupling& coupling, const ShaftLoad& load, const ShaftState& s) noexcept {
  const CouplingLaw law = lawOf(coupling, s);
  return (s.torque - law.moment(s.twist, s.motor_speed, s.speed)) / law.motor_inertia - load.hull_acceleration;
}

int advanceFlexible(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state,
                    FlexibleMatrix* total) noexcept {
  const double rate = 2.0 * kPi * model.coupling()->frequency * std::exp(0.5 * state.log_stiffness);
  int blows = 0, creeping = 0;
  double left = dt;
  for (int i = 0; i < kMaxSteps && left != 0.0; ++i) {
    const double needed =
        std::ceil(std::abs(left) * std::max(std::abs(state.speed) / kMaxStepAngle, rate / kMaxStepPhase));
    const double steps = std::clamp(needed, 1.0, static_cast<double>(kMaxSteps - i));
    const WayPiece piece = advancePiece(model, left / steps, passing.contact, state, total);
    left = steps == 1.0 && !piece.at_blow ? 0.0 : left - piece.used;
    if (!piece.at_blow) continue;
    blows += state.speed > 0.0;
    passBlowFlexible(model, dt > 0.0 ? passing.factor : 1.0 / passing.factor, state, total);
    if (std::abs(state.speed) < kCreeping && ++creeping == kMostCreepingPasses) break;
  }
  return blows;
}

void passBlowFlexible(const ShaftModel& model, double factor, ShaftState& state, FlexibleMatrix* total) noexcept {
  const Coupling& coupling = *model.coupling();
  const double beyond = state.position.angle.offset, speed = state.speed, motor_angle = state.twist + beyond;
  const double k = speed > 0.0 ? factor : 1.0;
  const auto at = [&](Side side) {
    state.position.angle = {0.0, side};
    const ShaftLoad load = model(state.position.angle);
    return std::pair(flexibleAcceleration(coupling, load, state), motorAcceleration(coupling, load, state));
  };
  const Side from = state.position.angle.side;
  const auto [before, motor_before] = at(from);
  state.speed *= k;
  const auto [after, motor_after] = at(from == Side::kBeforeBlow ? Side::kAfterBlow : Side::kBeforeBlow);
  const double inv = std::abs(speed) > kCreeping ? 1.0 / speed : 0.0;
  const double jump = (after - k * before) * inv, motor_jump = (motor_after - motor_before) * inv;
  state.position.angle.offset = k * beyond;
  state.twist = motor_angle - state.position.angle.offset;
  state.speed += jump * beyond;
  state.motor_speed += motor_jump * beyond;
  if (total == nullptr) return;
  total->row(kMotorSpeed) += motor_jump * total->row(0);
  total->row(1) = (k * total->row(1) + jump * total->row(0)).eval();
  total->row(0) *= k;
  if (!(speed > 0.0)) return;
  (*total)(0, 4) += beyond;
  (*total)(1, 4) += speed;
}

}  // namespace hammer_loads
