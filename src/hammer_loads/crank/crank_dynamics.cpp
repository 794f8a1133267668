#include "hammer_loads/crank/crank_dynamics.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

/// Offset [rad] and h = sqrt(M) w, M = Jc + J, within one half revolution.
struct Path {
  double offset{};
  double h{};
};

struct Shaft {
  const ShaftModel& model;
  Side side;
  double torque;
  double drive_inertia;
};

/// Torque of drive, weight and hull acceleration; the drive's inertia follows the latter.
double torqueOf(const ShaftLoad& load, double torque, double drive_inertia) noexcept {
  return torque + load.weight_torque - drive_inertia * load.hull_acceleration;
}

/// A path's first and second time derivative.
struct Rates {
  Path first, second;
};

/// Rates where the load is known.
Rates rates(const Shaft& shaft, double h, const ShaftLoad& load) noexcept {
  const double inv = 1.0 / (shaft.drive_inertia + load.inertia), inv_root = std::sqrt(inv);
  const double speed = h * inv_root, torque = torqueOf(load, shaft.torque, shaft.drive_inertia);
  return {{speed, torque * inv_root},
          {(torque - load.half_inertia_slope * speed * speed) * inv,
           (load.weight_torque_slope - torque * load.half_inertia_slope * inv) * speed * inv_root}};
}

/// Order 4 by two derivatives; needs a further load at the middle alone (Chan and Tsai 2010). at: rates at the start.
Path rungeKutta(const Shaft& shaft, const Path& start, const Rates& at, double dt) noexcept {
  const Path middle{start.offset + 0.5 * dt * (at.first.offset + 0.25 * dt * at.second.offset),
                    start.h + 0.5 * dt * (at.first.h + 0.25 * dt * at.second.h)};
  const Path bend = rates(shaft, middle.h, shaft.model({middle.offset, shaft.side})).second;
  const double part = dt / 6.0;
  return {start.offset + dt * (at.first.offset + part * (at.second.offset + 2.0 * bend.offset)),
          start.h + dt * (at.first.h + part * (at.second.h + 2.0 * bend.h))};
}

/// Derivatives of h by angle, speed and logarithm of the drive inertia, each with the others fixed.
struct Scaling {
  double by_angle, by_speed, by_log_inertia;
};

Scaling scaling(const ShaftLoad& load, double drive_inertia, double speed) noexcept {
  const double root = std::sqrt(drive_inertia + load.inertia);
  return {speed * load.half_inertia_slope / root, root, 0.5 * speed * drive_inertia / root};
}

/// Derivatives of the rates of (angle, h): by angle and h (`a11` is zero), by torque, by logarithm of drive inertia.
struct Linearised {
  double a00, a01, a10, h_by_torque, angle_by_inertia, h_by_inertia;
};

Linearised linearised(const Shaft& shaft, double speed, const ShaftLoad& load) noexcept {
  const double inv = 1.0 / (shaft.drive_inertia + load.inertia);
  const double inv_root = std::sqrt(inv);
  const double h_rate = torqueOf(load, shaft.torque, shaft.drive_inertia) * inv_root;
  const double slope = load.half_inertia_slope * inv, part = 0.5 * shaft.drive_inertia * inv;
  return {-speed * slope, inv_root,      load.weight_torque_slope * inv_root - h_rate * slope,
          inv_root,       -part * speed, -part * h_rate - shaft.drive_inertia * load.hull_acceleration * inv_root};
}

/// Transition of one smooth piece: second order in dt with the mean of both ends' linearisations.
ShaftTransition transition(const Shaft& shaft, double dt, double speed, const ShaftLoad& load, double speed_end,
                           const ShaftLoad& load_end) noexcept {
  const Linearised p = linearised(shaft, speed, load), q = linearised(shaft, speed_end, load_end);
  const double a = 0.5 * dt * (p.a00 + q.a00), b = 0.5 * dt * (p.a01 + q.a01), c = 0.5 * dt * (p.a10 + q.a10);
  const double half_bc = 0.5 * b * c;
  // Phi = 1 + A + A^2/2, Gamma = (1 + A/2) B with A = [a b; c 0]
  const double phi00 = 1.0 + a + 0.5 * a * a + half_bc, phi01 = b + 0.5 * a * b, phi10 = c + 0.5 * a * c;
  const double phi11 = 1.0 + half_bc;
  const double torque_h = 0.5 * dt * (p.h_by_torque + q.h_by_torque);
  const double inertia_angle = 0.5 * dt * (p.angle_by_inertia + q.angle_by_inertia);
  const double inertia_h = 0.5 * dt * (p.h_by_inertia + q.h_by_inertia);
  const Scaling from = scaling(load, shaft.drive_inertia, speed),
                to = scaling(load_end, shaft.drive_inertia, speed_end);
  ShaftTransition f = ShaftTransition::Zero();
  f(0, 0) = phi00 + phi01 * from.by_angle;
  f(0, 1) = phi01 * from.by_speed;
  f(0, 2) = 0.5 * b * torque_h;
  f(0, 3) = phi01 * from.by_log_inertia + inertia_angle + 0.5 * (a * inertia_angle + b * inertia_h);
  f(1, 0) = phi10 + phi11 * from.by_angle;
  f(1, 1) = phi11 * from.by_speed;
  f(1, 2) = torque_h;
  f(1, 3) = phi11 * from.by_log_inertia + inertia_h + 0.5 * c * inertia_angle - to.by_log_inertia;
  f.row(1) = (f.row(1) - to.by_angle * f.row(0)) / to.by_speed;
  return f;
}

/// Returns the transition by `first`, then by `second`.
ShaftTransition chained(const ShaftTransition& second, const ShaftTransition& first) noexcept {
  ShaftTransition both = second.leftCols<2>() * first;
  both.rightCols<3>() += second.rightCols<3>();
  return both;
}

/// Returns true if the blow lies in between. A state on the mirrored branch is beyond it already.
bool passesBlow(Side side, double from, double to) noexcept { return isBeyond(side, to) && !isBeyond(side, from); }

/// Advances by one smooth piece, which ends at dt or at the blow. total: null if no linearisation is needed.
WayPiece advancePiece(const ShaftModel& model, double dt, bool contact, ShaftState& state, ShaftLoad& load,
                      ShaftTransition* total) noexcept {
  const Shaft shaft{model, state.position.angle.side, state.torque, state.drive_inertia};
  const Path start{state.position.angle.offset, std::sqrt(state.drive_inertia + load.inertia) * state.speed};
  const Rates at = rates(shaft, start.h, load);
  Path end = rungeKutta(shaft, start, at, dt);
  const bool forward = (shaft.side == Side::kBeforeBlow) == (dt > 0.0);  // not falling back onto the tool
  WayPiece piece{dt, (contact || !forward) && passesBlow(shaft.side, start.offset, end.offset)};
  if (piece.at_blow) {
    piece.used =
        timeToBlow([&](double t) { return rungeKutta(shaft, start, at, t).offset; }, start.offset, end.offset, dt);
    end = rungeKutta(shaft, start, at, piece.used);
    end.offset = 0.0;
  }
  const ShaftLoad load_end = model({end.offset, shaft.side});
  const double speed_end = end.h / std::sqrt(state.drive_inertia + load_end.inertia);
  if (total != nullptr) *total = chained(transition(shaft, piece.used, state.speed, load, speed_end, load_end), *total);
  state.position.angle.offset = end.offset;
  state.position.renormalise();
  state.speed = speed_end;
  load = load_end;
  return piece;
}

/// Returns the number of blows passed forward. total: as in advancePiece().
int advanceAll(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state, ShaftLoad& load,
               ShaftTransition* total) noexcept {
  int blows = 0, creeping = 0;
  double left = dt;
  for (int i = 0; i < kMaxSteps && left != 0.0; ++i) {
    const double steps_needed = std::ceil(std::abs(left * state.speed) / kMaxStepAngle);
    const double steps = std::clamp(steps_needed, 1.0, static_cast<double>(kMaxSteps - i));
    const WayPiece piece = advancePiece(model, left / steps, passing.contact, state, load, total);
    left = steps == 1.0 && !piece.at_blow ? 0.0 : left - piece.used;
    if (!piece.at_blow) continue;
    const bool strikes = state.speed > 0.0;
    ShaftTransition unused = ShaftTransition::Identity();
    passBlow(model, dt > 0.0 ? passing.factor : 1.0 / passing.factor, state, load, total != nullptr ? *total : unused);
    blows += strikes;
    if (std::abs(state.speed) < kCreeping && ++creeping == kMostCreepingPasses) break;
  }
  return blows;
}

}  // namespace

double acceleration(const ShaftLoad& load, const ShaftState& state) noexcept {
  return (torqueOf(load, state.torque, state.drive_inertia) - load.half_inertia_slope * state.speed * state.speed) /
         (state.drive_inertia + load.inertia);
}

void passBlow(const ShaftModel& model, double factor, ShaftState& state, ShaftLoad& load,
              ShaftTransition& total) noexcept {
  const double beyond = state.position.angle.offset, speed = state.speed;
  const double k = speed > 0.0 ? factor : 1.0;
  const auto at = [&](Side side) {
    state.position.angle = {0.0, side};
    load = model(state.position.angle);
    return acceleration(load, state);
  };
  const Side from = state.position.angle.side;
  const double before = at(from);
  state.speed *= k;
  const double after = at(from == Side::kBeforeBlow ? Side::kAfterBlow : Side::kBeforeBlow);
  const double jump = std::abs(speed) > kCreeping ? (after - k * before) / speed : 0.0;
  total.row(1) = k * total.row(1) + jump * total.row(0);
  total.row(0) *= k;
  total(1, 4) += speed > 0.0 ? speed : 0.0;
  if (beyond == 0.0) return;
  total(0, 4) += speed > 0.0 ? beyond : 0.0;
  state.position.angle.offset = k * beyond;
  state.speed += jump * beyond;
  load = model(state.position.angle);
}

Advance advance(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state,
                ShaftLoad& load) noexcept {
  Advance result{ShaftTransition::Identity()};
  result.blows = advanceAll(model, dt, passing, state, load, &result.transition);
  return result;
}

void advanceState(const ShaftModel& model, double dt, const Passing& passing, ShaftState& state) noexcept {
  ShaftLoad load = model(state.position.angle);
  advanceAll(model, dt, passing, state, load, nullptr);
}

}  // namespace hammer_loads
