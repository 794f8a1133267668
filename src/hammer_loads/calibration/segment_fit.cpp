#include "hammer_loads/calibration/segment_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hammer_loads::calibration {
namespace {

double square(double x) { return x * x; }

/// The reading beyond zero and its slope at an offset.
struct Seen {
  double value, slope;
};

Seen seenAt(const Globals& g, double offset) {
  const double s1 = std::sin(offset), c1 = std::cos(offset), s2 = 2.0 * s1 * c1, c2 = 1.0 - 2.0 * s1 * s1;
  return {g[kZero] + offset + g[kSine1] * s1 + g[kCosine1] * (c1 - 1.0) + g[kSine2] * s2 + g[kCosine2] * (c2 - 1.0),
          1.0 + g[kSine1] * c1 - g[kCosine1] * s1 + 2.0 * (g[kSine2] * c2 - g[kCosine2] * s2)};
}

/// Huber's weight of a residual in deviations, and its cost.
double weightOf(double r) { return std::abs(r) <= kHuber ? 1.0 : kHuber / std::abs(r); }
double costOf(double r) { return std::abs(r) <= kHuber ? 0.5 * r * r : kHuber * (std::abs(r) - 0.5 * kHuber); }

double angleDeviation(const Noise& noise, double speed) {
  return std::sqrt(square(noise.angle) + square(speed * noise.timing));
}

/// Standard normal, the same with every standard library (Box-Muller).
double normal(std::mt19937_64& random) {
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double u = 1.0 - uniform(), v = uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(kTwoPi * v);
}

/// Straight line through points [begin, end): value at `time`, and slope.
struct Line {
  double value, slope;
};

Line lineThrough(const std::vector<CrankPoint>& p, std::size_t begin, std::size_t end, double time) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double t = p[i].time - time;
    n += 1.0, x += t, y += p[i].seen, xx += t * t, xy += t * p[i].seen;
  }
  const double spread = n * xx - x * x;
  const double slope = spread > 0.0 ? (n * xy - x * y) / spread : 0.0;
  return {(y - slope * x) / n, slope};
}

}  // namespace

SegmentFit::SegmentFit(const BlowSegment& segment, const Globals& globals) : segment_(&segment) {
  const auto& p = segment.points;
  std::size_t after = 0;
  while (after < p.size() && p[after].seen < globals[kZero]) ++after;
  after = std::clamp<std::size_t>(after, 3, p.size() - 3);
  const auto wide = [&](std::size_t i) { return std::abs(p[i].seen - p[after].seen) > 0.2; };
  std::size_t low = after - 3, high = after + 3;
  while (low > 0 && !wide(low - 1)) --low;
  while (high < p.size() && !wide(high)) ++high;
  const double middle = p[after].time;
  const Line before_line = lineThrough(p, low, after, middle), after_line = lineThrough(p, after, high, middle);
  const double slowest = 1.0;
  locals_.setZero();
  locals_[kSpeedBefore] = std::max(before_line.slope, slowest);
  locals_[kSpeedAfter] = std::max(after_line.slope, slowest);
  locals_[kInstant] = middle + (globals[kZero] - after_line.value) / locals_[kSpeedAfter];
  locals_[kInstant] = std::clamp(locals_[kInstant], p[after - 1].time, p[after].time);
  mean_speed_ = (p.back().seen - p.front().seen) / (p.back().time - p.front().time);
  node_step_ = std::max(p.back().time - middle, middle - p.front().time) / kNodesBeside;
}

std::size_t SegmentFit::beforeCount(const Locals& locals) const {
  const auto& p = segment_->points;
  const auto at =
      std::partition_point(p.begin(), p.end(), [&](const CrankPoint& point) { return point.time < locals[kInstant]; });
  return static_cast<std::size_t>(at - p.begin());
}

/// Where one of the blow's own parameters shows.
SegmentFit::Sides SegmentFit::sidesOf(Eigen::Index local) noexcept {
  if (local == kSpeedBefore || (local >= kTorques && local < kTorques + kNodesBeside)) return Sides::kBefore;
  if (local == kSpeedAfter || (local >= kTorques + kNodesBeside && local < kLocals)) return Sides::kAfter;
  return Sides::kBoth;
}

/// Points of all samples, in their order.
void SegmentFit::run(const SegmentModel& model, const Globals& globals, const Locals& locals, Sides sides,
                     std::vector<ShotPoint>& points) const {
  const auto& p = segment_->points;
  const std::size_t before = beforeCount(locals);
  ShaftModel shaft(model.mechanism, model.level);
  shaft.setHullMotion(segment_->gravity);
  std::vector<double> times;
  std::vector<ShotPoint> side;
  points.resize(p.size());
  for (const bool is_before : {true, false}) {
    if (sides == (is_before ? Sides::kAfter : Sides::kBefore)) continue;
    HalfShot half;
    half.before = is_before;
    half.speed = locals[is_before ? kSpeedBefore : kSpeedAfter];
    for (int i = 0; i <= kNodesBeside; ++i) half.torque[i] = locals[torqueIndex(is_before, i)];
    half.node_step = node_step_;
    half.drive_inertia = std::exp(globals[kLogInertia]);
    half.law = {mean_speed_, globals[kStiffness], globals[kDrag]};
    times.clear();
    if (is_before) {
      for (std::size_t i = before; i-- > 0;) times.push_back(locals[kInstant] - p[i].time);
    } else {
      for (std::size_t i = before; i < p.size(); ++i) times.push_back(p[i].time - locals[kInstant]);
    }
    shoot(shaft, half, times, side);
    for (std::size_t i = 0; i < side.size(); ++i) points[is_before ? before - 1 - i : before + i] = side[i];
  }
}

double SegmentFit::cost(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
  std::vector<ShotPoint> points;
  run(model, globals, locals_, Sides::kBoth, points);
  double cost = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Seen seen = seenAt(globals, points[i].offset);
    const double deviation = angleDeviation(noise, points[i].speed);
    cost += costOf((segment_->points[i].seen - seen.value) / deviation) + std::log(deviation / noise.angle);
    if (segment_->points[i].speed) {
      cost += costOf((*segment_->points[i].speed - seen.slope * points[i].speed) / noise.speed);
    }
  }
  const double step = noise.torque_walk * std::sqrt(node_step_);
  for (const bool before : {true, false}) {
    for (int i = 1; i <= kNodesBeside; ++i)
      cost += 0.5 * square((locals_[torqueIndex(before, i)] - locals_[torqueIndex(before, i - 1)]) / step);
  }
  return cost + 0.5 * square(locals_[kTorqueAtBlow] / noise.torque);
}

NormalEquations SegmentFit::linearise(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
  constexpr double kSpeedStep = 1e-3, kTorqueStep = 0.5, kShapeSteps[kShaping] = {1e-3, 0.1, 1e-2};
  constexpr int kMoving = kLocals + kShaping;
  std::vector<ShotPoint> base, moved;
  run(model, globals, locals_, Sides::kBoth, base);
  const std::size_t n = base.size();
  // Derivatives of (offset, speed) by locals and logarithm of inertia, by differences; by the instant: the motion
  // itself.
  std::vector<Eigen::Matrix<double, 2, kMoving>> slopes(n);
  for (std::size_t i = 0; i < n; ++i) slopes[i].col(kInstant) << -base[i].speed, -base[i].acceleration;
  for (Eigen::Index k = kSpeedBefore; k < kMoving; ++k) {
    Locals locals = locals_;
    Globals other = globals;
    const bool shared = k >= kLocals;
    const double step = shared ? kShapeSteps[k - kLocals] : k <= kSpeedAfter ? kSpeedStep : kTorqueStep;
    (shared ? other[kLogInertia + k - kLocals] : locals[k]) += step;
    moved = base;
    run(model, other, locals, shared ? Sides::kBoth : sidesOf(k), moved);
    for (std::size_t i = 0; i < n; ++i)
      slopes[i].col(k) << (moved[i].offset - base[i].offset) / step, (moved[i].speed - base[i].speed) / step;
  }

  NormalEquations e;
  e.ll.setZero(), e.ll_data.setZero(), e.lg.setZero(), e.gg.setZero(), e.l.setZero(), e.g.setZero();
  const auto add = [&](const Locals& by_local, const Globals& by_global, double residual, double deviation) {
    const double r = residual / deviation, weight = weightOf(r) / square(deviation);
    e.ll_data.noalias() += weight * by_local * by_local.transpose();
    e.lg.noalias() += weight * by_local * by_global.transpose();
    e.gg.noalias() += weight * by_global * by_global.transpose();
    e.l += weight * residual * by_local;
    e.g += weight * residual * by_global;
    e.cost += costOf(r);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const CrankPoint& point = segment_->points[i];
    const double offset = base[i].offset, speed = base[i].speed;
    const Seen seen = seenAt(globals, offset);
    const double s1 = std::sin(offset), c1 = std::cos(offset), s2 = 2.0 * s1 * c1, c2 = 1.0 - 2.0 * s1 * s1;
    Globals by_global;
    by_global << 1.0, s1, c1 - 1.0, s2, c2 - 1.0, seen.slope * slopes[i].row(0).tail<kShaping>().transpose();
    const double deviation = angleDeviation(noise, speed);
    add(seen.slope * slopes[i].row(0).head<kLocals>().transpose(), by_global, point.seen - seen.value, deviation);
    e.cost += std::log(deviation / noise.angle);
    if (!point.speed) continue;
    const double bend =
        -globals[kSine1] * s1 - globals[kCosine1] * c1 - 4.0 * (globals[kSine2] * s2 + globals[kCosine2] * c2);
    const Eigen::Matrix<double, 1, kMoving> by_motion = seen.slope * slopes[i].row(1) + speed * bend * slopes[i].row(0);
    by_global << 0.0, speed * c1, -speed * s1, 2.0 * speed * c2, -2.0 * speed * s2,
        by_motion.tail<kShaping>().transpose();
    add(by_motion.head<kLocals>().transpose(), by_global, *point.speed - seen.slope * speed, noise.speed);
  }
  e.ll = e.ll_data;
  const double walk = 1.0 / (square(noise.torque_walk) * node_step_);
  for (const bool before : {true, false}) {
    for (int i = 1; i <= kNodesBeside; ++i) {
      const Eigen::Index a = torqueIndex(before, i), b = torqueIndex(before, i - 1);
      const double change = locals_[a] - locals_[b];
      e.ll(a, a) += walk, e.ll(b, b) += walk, e.ll(a, b) -= walk, e.ll(b, a) -= walk;
      e.l[a] -= walk * change, e.l[b] += walk * change;
      e.cost += 0.5 * walk * square(change);
    }
  }
  e.ll(kTorqueAtBlow, kTorqueAtBlow) += 1.0 / square(noise.torque);
  e.l[kTorqueAtBlow] -= locals_[kTorqueAtBlow] / square(noise.torque);
  e.cost += 0.5 * square(locals_[kTorqueAtBlow] / noise.torque);
  return e;
}

BlowSegment SegmentFit::replica(const SegmentModel& model, const Globals& globals, const Noise& noise, double count,
                                std::mt19937_64& random) const {
  std::vector<ShotPoint> points;
  run(model, globals, locals_, Sides::kBoth, points);
  BlowSegment replica = *segment_;
  const double centre = segment_->points.front().seen;  // of some count
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double late = noise.timing * normal(random);
    const Seen seen = seenAt(globals, points[i].offset + late * points[i].speed);
    double& value = replica.points[i].seen;
    value = seen.value + (noise.angle_known ? 0.0 : noise.angle * normal(random));
    if (count > 0.0) value = centre + count * std::nearbyint((value - centre) / count);
    if (replica.points[i].speed) replica.points[i].speed = seen.slope * points[i].speed + noise.speed * normal(random);
  }
  return replica;
}

std::vector<ResidualAt> SegmentFit::residuals(const SegmentModel& model, const Globals& globals) const {
  std::vector<ShotPoint> points;
  run(model, globals, locals_, Sides::kBoth, points);
  std::vector<ResidualAt> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Seen seen = seenAt(globals, points[i].offset);
    const std::optional<double>& speed = segment_->points[i].speed;
    all.push_back({points[i].offset, points[i].speed, segment_->points[i].seen - seen.value,
                   speed ? *speed - seen.slope * points[i].speed : std::numeric_limits<double>::quiet_NaN()});
  }
  return all;
}

}  // namespace hammer_loads::calibration
