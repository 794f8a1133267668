#include "hammer_loads/crank/crank_dynamics.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kMaxStepAngle = 0.05;  // [rad]; the transfer functions change over some 0.3 rad near the blow
constexpr int kMaxSteps = 4096;         // bounds the work for absurd speeds; steps get longer beyond it

/// Offset and h within one half turn, with their derivatives by (angle, h, torque, drive inertia) at the start.
struct Path {
  double offset{};
  double h{};
  Eigen::Matrix<double, 2, 4> sensitivity;
};

struct Shaft {
  const ShaftModel& model;
  Side side;
  double torque;
  double drive_inertia;
};

/// Time derivative of a path.
Path rate(const Shaft& shaft, const Path& at) noexcept {
  const ShaftLoad load = shaft.model({at.offset, shaft.side});
  const double total = shaft.drive_inertia + load.inertia;
  const double inv = 1.0 / total;
  const double inv_root = std::sqrt(inv);
  const double speed = at.h * inv_root;
  const double h_rate = (shaft.torque + load.weight_torque) * inv_root;
  const double slope = load.half_inertia_slope * inv;
  const double a00 = -speed * slope, a01 = inv_root, a10 = load.weight_torque_slope * inv_root - h_rate * slope;
  Path derivative;
  derivative.offset = speed;
  derivative.h = h_rate;
  derivative.sensitivity.row(0) = a00 * at.sensitivity.row(0) + a01 * at.sensitivity.row(1);
  derivative.sensitivity.row(1) = a10 * at.sensitivity.row(0);
  derivative.sensitivity(1, 2) += inv_root;
  derivative.sensitivity(0, 3) -= 0.5 * speed * inv;
  derivative.sensitivity(1, 3) -= 0.5 * h_rate * inv;
  return derivative;
}

Path along(const Path& start, const Path& derivative, double dt) noexcept {
  return {start.offset + dt * derivative.offset, start.h + dt * derivative.h,
          start.sensitivity + dt * derivative.sensitivity};
}

Path rungeKutta(const Shaft& shaft, const Path& start, double dt) noexcept {
  const Path k1 = rate(shaft, start);
  const Path k2 = rate(shaft, along(start, k1, 0.5 * dt));
  const Path k3 = rate(shaft, along(start, k2, 0.5 * dt));
  const Path k4 = rate(shaft, along(start, k3, dt));
  const double w = dt / 6.0;
  return {start.offset + w * (k1.offset + 2.0 * (k2.offset + k3.offset) + k4.offset),
          start.h + w * (k1.h + 2.0 * (k2.h + k3.h) + k4.h),
          start.sensitivity +
              w * (k1.sensitivity + 2.0 * (k2.sensitivity + k3.sensitivity) + k4.sensitivity)};
}

/// d(angle, h)/d(angle, speed, torque, drive inertia) as a full matrix.
ShaftMatrix toH(const ShaftLoad& load, double drive_inertia, double speed) noexcept {
  const double root = std::sqrt(drive_inertia + load.inertia);
  ShaftMatrix t = ShaftMatrix::Identity();
  t(1, 0) = speed * load.half_inertia_slope / root;
  t(1, 1) = root;
  t(1, 3) = 0.5 * speed / root;
  return t;
}

ShaftMatrix fromH(const ShaftLoad& load, double drive_inertia, double speed) noexcept {
  const double total = drive_inertia + load.inertia;
  ShaftMatrix t = ShaftMatrix::Identity();
  t(1, 0) = -speed * load.half_inertia_slope / total;
  t(1, 1) = 1.0 / std::sqrt(total);
  t(1, 3) = -0.5 * speed / total;
  return t;
}

bool passedBlow(Side side, double offset) noexcept {
  return side == Side::kBeforeBlow ? offset > 0.0 : offset < 0.0;
}

/// Part of the step dt after which the path is at the blow: safeguarded secant on the smooth continuation.
double timeToBlow(const Shaft& shaft, const Path& start, const Path& end, double dt) noexcept {
  double low = 0.0, high = dt, f_low = start.offset, f_high = end.offset;
  double t = 0.0;
  for (int i = 0; i < 8; ++i) {
    t = low - f_low * (high - low) / (f_high - f_low);
    const double f = rungeKutta(shaft, start, t).offset;
    if (std::abs(f) < 1e-13) break;
    (std::signbit(f) == std::signbit(f_low) ? low : high) = t;
    (std::signbit(f) == std::signbit(f_low) ? f_low : f_high) = f;
  }
  return t;
}

/// Speed and matrix of one smooth piece of the way.
struct Piece {
  double used;
  bool at_blow;
};

Piece advancePiece(const ShaftModel& model, double dt, ShaftState& state, ShaftMatrix& total) noexcept {
  const CrankAngle from = state.position.angle;
  const Shaft shaft{model, from.side, state.torque, state.drive_inertia};
  const ShaftLoad load = model(from);
  Path start;
  start.offset = from.offset;
  start.h = std::sqrt(state.drive_inertia + load.inertia) * state.speed;
  start.sensitivity.setZero();
  start.sensitivity(0, 0) = start.sensitivity(1, 1) = 1.0;

  Path end = rungeKutta(shaft, start, dt);
  Piece piece{dt, passedBlow(from.side, end.offset)};
  if (piece.at_blow) {
    piece.used = timeToBlow(shaft, start, end, dt);
    end = rungeKutta(shaft, start, piece.used);
    end.offset = 0.0;
  }
  const CrankAngle to{end.offset, from.side};
  const ShaftLoad load_end = model(to);
  const double speed_end = end.h / std::sqrt(state.drive_inertia + load_end.inertia);
  ShaftMatrix step = ShaftMatrix::Identity();
  step.topRows<2>() = end.sensitivity;
  total = fromH(load_end, state.drive_inertia, speed_end) * step * toH(load, state.drive_inertia, state.speed) * total;
  state.position.angle = to;
  state.position.renormalise();
  state.speed = speed_end;
  return piece;
}

/// Passes the blow: position and speed are continuous, the acceleration jumps. A path that reaches the blow later by
/// d(angle)/w keeps the old acceleration for so much longer (saltation).
void passBlow(const ShaftModel& model, ShaftState& state, ShaftMatrix& total) noexcept {
  const double before = acceleration(model(state.position.angle), state);
  state.position.angle.side = state.position.angle.side == Side::kBeforeBlow ? Side::kAfterBlow : Side::kBeforeBlow;
  const double after = acceleration(model(state.position.angle), state);
  constexpr double kSlow = 1.0;  // [rad/s]: a crank that creeps over the blow has no defined instant of passing it
  if (std::abs(state.speed) > kSlow) total.row(1) += ((after - before) / state.speed) * total.row(0);
}

}  // namespace

double acceleration(const ShaftLoad& load, const ShaftState& state) noexcept {
  return (state.torque + load.weight_torque - load.half_inertia_slope * state.speed * state.speed) /
         (state.drive_inertia + load.inertia);
}

ShaftMatrix advance(const ShaftModel& model, double dt, ShaftState& state) noexcept {
  ShaftMatrix total = ShaftMatrix::Identity();
  double left = dt;
  for (int i = 0; i < kMaxSteps && left != 0.0; ++i) {
    const double steps_needed = std::ceil(std::abs(left * state.speed) / kMaxStepAngle);
    const double steps = std::clamp(steps_needed, 1.0, static_cast<double>(kMaxSteps - i));
    const Piece piece = advancePiece(model, left / steps, state, total);
    left = steps == 1.0 && !piece.at_blow ? 0.0 : left - piece.used;
    if (piece.at_blow) passBlow(model, state, total);
  }
  total.col(3).head<3>() *= state.drive_inertia;
  return total;
}

}  // namespace hammer_loads
