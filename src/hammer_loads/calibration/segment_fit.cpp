#include "hammer_loads/calibration/segment_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::calibration {
namespace {

/// Reading at an offset, with its derivatives.
struct Seen {
  Seen(const Globals& g, double offset)
      : s1(std::sin(offset)), c1(std::cos(offset)), s2(2.0 * s1 * c1), c2(1.0 - 2.0 * s1 * s1) {
    value = g[kZero] + offset + g[kSine1] * s1 + g[kCosine1] * (c1 - 1.0) + g[kSine2] * s2 + g[kCosine2] * (c2 - 1.0);
    slope = 1.0 + g[kSine1] * c1 - g[kCosine1] * s1 + 2.0 * (g[kSine2] * c2 - g[kCosine2] * s2);
    bend = -g[kSine1] * s1 - g[kCosine1] * c1 - 4.0 * (g[kSine2] * s2 + g[kCosine2] * c2);
  }
  double s1, c1, s2, c2;      ///< sine and cosine of the offset, and of twice it
  double value, slope, bend;  ///< reading [rad], its first and second derivative by the offset
};

/// Residual beyond which a sample has less weight (Huber) [standard deviations].
constexpr double kHuber = gate::kRare;

/// Huber's weight of a residual in standard deviations, and its cost.
double weightOf(double r) { return std::abs(r) <= kHuber ? 1.0 : kHuber / std::abs(r); }
double costOf(double r) { return std::abs(r) <= kHuber ? 0.5 * r * r : kHuber * (std::abs(r) - 0.5 * kHuber); }

/// Returns a standard normal number, equal with every standard library (Box-Muller).
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
  node_step_ = std::max(p.back().time - middle, middle - p.front().time) / kNodesPerSide;
}

std::size_t SegmentFit::beforeCount() const {
  const auto& p = segment_->points;
  const auto at =
      std::partition_point(p.begin(), p.end(), [&](const CrankPoint& point) { return point.time < locals_[kInstant]; });
  return static_cast<std::size_t>(at - p.begin());
}

HalfShot SegmentFit::halfOf(const Globals& globals, bool before) const {
  HalfShot half;
  half.before = before;
  half.speed = locals_[before ? kSpeedBefore : kSpeedAfter];
  for (int i = 0; i <= kNodesPerSide; ++i) half.torque[i] = locals_[torqueIndex(before, i)];
  half.node_step = node_step_;
  half.drive_inertia = std::exp(globals[kLogInertia]);
  half.law = {mean_speed_, globals[kStiffness], globals[kDrag]};
  return half;
}

std::vector<ShotPoint> SegmentFit::motion(const SegmentModel& model, const Globals& globals,
                                          std::vector<MotionSlopes>* slopes) const {
  const auto& p = segment_->points;
  const std::size_t before = beforeCount();
  ShaftModel shaft = model.shaft;
  shaft.setHullMotion(segment_->gravity);
  std::vector<double> times;
  std::vector<ShotPoint> points(p.size()), side;
  std::vector<ShotSlopes> side_slopes;
  if (slopes) slopes->assign(p.size(), MotionSlopes::Zero());
  for (const bool is_before : {true, false}) {
    const HalfShot half = halfOf(globals, is_before);
    const auto place = [&](std::size_t i) { return is_before ? before - 1 - i : before + i; };
    times.clear();
    for (std::size_t i = 0; i < (is_before ? before : p.size() - before); ++i)
      times.push_back(std::abs(p[place(i)].time - locals_[kInstant]));
    shoot(shaft, half, times, side, slopes ? &side_slopes : nullptr);
    for (std::size_t i = 0; i < side.size(); ++i) points[place(i)] = side[i];
    if (!slopes) continue;
    for (std::size_t i = 0; i < side.size(); ++i) {
      MotionSlopes& all = (*slopes)[place(i)];
      all.col(kInstant) << -side[i].speed, -side[i].acceleration;
      all.col(is_before ? kSpeedBefore : kSpeedAfter) = side_slopes[i].col(kOwnSpeed);
      for (int node = 0; node <= kNodesPerSide; ++node)
        all.col(torqueIndex(is_before, node)) = side_slopes[i].col(kOwnTorques + node);
      all.rightCols<kShaping>() = side_slopes[i].middleCols<kShaping>(kOwnLogInertia);
    }
  }
  return points;
}

/// A timing error d changes the angle by w d and the speed by w' d. Near the blow, the measurement may lie on its other
/// side, where the crank has another speed.
Weighing SegmentFit::weighing(const Noise& noise, double time, const ShotPoint& at) const {
  const double variance = square(noise.timing), angle = square(noise.angle) + square(at.speed) * variance;
  const double both = at.speed * at.acceleration * variance, share = both / angle;
  double speed = square(noise.speed) + square(at.acceleration) * variance - share * both;
  if (noise.timing > 0.0) {
    const double other = 0.5 * std::erfc(std::abs(time - locals_[kInstant]) / (noise.timing * std::sqrt(2.0)));
    speed += other * (1.0 - other) * square(locals_[kSpeedAfter] - locals_[kSpeedBefore]);
  }
  return {std::sqrt(angle), std::sqrt(speed), share};
}

double SegmentFit::cost(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
  double cost = 0.0;
  for (const ResidualAt& r : residuals(model, globals, noise)) {
    cost += costOf(r.angle / r.deviation.angle) + std::log(r.deviation.angle / noise.angle);
    if (std::isnan(r.speed_error)) continue;
    cost += costOf(r.speed_error / r.deviation.speed) + std::log(r.deviation.speed / noise.speed);
  }
  const double step = noise.torque_walk * std::sqrt(node_step_);
  for (const bool before : {true, false}) {
    for (int i = 1; i <= kNodesPerSide; ++i)
      cost += 0.5 * square((locals_[torqueIndex(before, i)] - locals_[torqueIndex(before, i - 1)]) / step);
  }
  return cost + 0.5 * square(locals_[kTorqueAtBlow] / noise.torque);
}

std::vector<ResidualRow> SegmentFit::rows(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
  std::vector<MotionSlopes> slopes;
  const std::vector<ShotPoint> points = motion(model, globals, &slopes);
  const std::vector<ResidualAt> residuals = residualsAt(points, globals, noise);
  std::vector<ResidualRow> rows;
  rows.reserve(2 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double speed = points[i].speed, share = residuals[i].deviation.share;
    const Seen seen(globals, points[i].offset);
    const auto by_offset = slopes[i].row(0), by_speed = slopes[i].row(1);
    ResidualRow angle{i, points[i], false, residuals[i].angle, residuals[i].deviation.angle, {}, {}, seen.slope, 0.0};
    angle.by_local = seen.slope * by_offset.head<kLocals>().transpose();
    angle.by_global << 1.0, seen.s1, seen.c1 - 1.0, seen.s2, seen.c2 - 1.0,
        seen.slope * by_offset.tail<kShaping>().transpose();
    rows.push_back(angle);
    if (std::isnan(residuals[i].speed_error)) continue;
    const Eigen::Matrix<double, 1, kLocals + kShaping> by_motion =
        seen.slope * by_speed + speed * seen.bend * by_offset;
    ResidualRow of_speed{i,  points[i], true,      residuals[i].speed_error, residuals[i].deviation.speed, {},
                         {}, 0.0,       seen.slope};
    of_speed.by_offset = speed * seen.bend - share * seen.slope;
    of_speed.by_local = by_motion.head<kLocals>().transpose() - share * angle.by_local;
    of_speed.by_global << 0.0, speed * seen.c1, -speed * seen.s1, 2.0 * speed * seen.c2, -2.0 * speed * seen.s2,
        by_motion.tail<kShaping>().transpose();
    of_speed.by_global -= share * angle.by_global;
    rows.push_back(of_speed);
  }
  return rows;
}

double weightOf(const ResidualRow& row) { return weightOf(row.residual / row.deviation) / square(row.deviation); }

NormalEquations SegmentFit::equationsOf(const std::vector<ResidualRow>& rows, const Noise& noise) const {
  NormalEquations e;
  for (const ResidualRow& row : rows) {
    const double weight = weightOf(row);
    LocalMatrix& ll = row.of_speed ? e.ll_speeds : e.ll_angles;
    ll.noalias() += weight * row.by_local * row.by_local.transpose();
    e.lg.noalias() += weight * row.by_local * row.by_global.transpose();
    e.gg.noalias() += weight * row.by_global * row.by_global.transpose();
    e.l += weight * row.residual * row.by_local;
    e.g += weight * row.residual * row.by_global;
  }
  e.ll = e.ll_angles + e.ll_speeds;
  const double walk = 1.0 / (square(noise.torque_walk) * node_step_);
  for (const bool before : {true, false}) {
    for (int i = 1; i <= kNodesPerSide; ++i) {
      const Eigen::Index a = torqueIndex(before, i), b = torqueIndex(before, i - 1);
      const double change = locals_[a] - locals_[b];
      e.ll(a, a) += walk, e.ll(b, b) += walk, e.ll(a, b) -= walk, e.ll(b, a) -= walk;
      e.l[a] -= walk * change, e.l[b] += walk * change;
    }
  }
  e.ll(kTorqueAtBlow, kTorqueAtBlow) += 1.0 / square(noise.torque);
  e.l[kTorqueAtBlow] -= locals_[kTorqueAtBlow] / square(noise.torque);
  return e;
}

BlowSegment SegmentFit::replica(const SegmentModel& model, const Globals& globals, const Noise& noise, double count,
                                double sign, std::mt19937_64& random) const {
  struct Taken {
    double time;
    std::size_t place;
  };
  std::vector<Taken> taken;
  for (std::size_t i = 0; i < size(); ++i)
    taken.push_back({segment_->points[i].time + sign * noise.timing * normal(random), i});
  std::sort(taken.begin(), taken.end(), [](const Taken& a, const Taken& b) { return a.time < b.time; });
  BlowSegment instants = *segment_;
  for (std::size_t i = 0; i < size(); ++i) instants.points[i].time = taken[i].time;
  const std::vector<ShotPoint> points = onto(instants).motion(model, globals);
  BlowSegment replica = *segment_;
  const double centre = segment_->points.front().seen;  // centre of a count
  for (std::size_t i = 0; i < size(); ++i) {
    const Seen seen(globals, points[i].offset);
    CrankPoint& point = replica.points[taken[i].place];
    point.seen = seen.value + (noise.angle_known ? 0.0 : sign * noise.angle * normal(random));
    if (count > 0.0) point.seen += sign * (centre + count * std::nearbyint((point.seen - centre) / count) - point.seen);
    if (point.speed) point.speed = seen.slope * points[i].speed + sign * noise.speed * normal(random);
  }
  return replica;
}

std::vector<ResidualAt> SegmentFit::residualsAt(const std::vector<ShotPoint>& points, const Globals& globals,
                                                const Noise& noise) const {
  std::vector<ResidualAt> all;
  all.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CrankPoint& point = segment_->points[i];
    const Seen seen(globals, points[i].offset);
    const Weighing deviation = weighing(noise, point.time, points[i]);
    const double angle = point.seen - seen.value;
    all.push_back({points[i].offset, points[i].speed, angle,
                   point.speed ? *point.speed - seen.slope * points[i].speed - deviation.share * angle
                               : std::numeric_limits<double>::quiet_NaN(),
                   deviation});
  }
  return all;
}

}  // namespace hammer_loads::calibration
