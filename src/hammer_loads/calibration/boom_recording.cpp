#include "hammer_loads/calibration/boom_recording.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kLeastHalfWidth = 0.20;  // [s]; an operator's motion is parabolic over it, oil vibration averages out
constexpr std::ptrdiff_t kLeastReadings = 7;  // the noise can be estimated from the fifth one on

/// Parabola through the readings around an instant.
struct LocalFit {
  double value{}, rate{}, acceleration{};
  double rate_std{};  ///< standard deviation from the residuals
};

std::optional<LocalFit> fitAround(const Trace& trace, double time, double half_width) {
  const auto first = std::lower_bound(trace.time.begin(), trace.time.end(), time - half_width);
  const auto last = std::upper_bound(first, trace.time.end(), time + half_width);
  const std::ptrdiff_t count = last - first;
  if (count < kLeastReadings || *first > time - 0.5 * half_width || *(last - 1) < time + 0.5 * half_width) return {};
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double square = 0.0;
  const double level = trace.value[static_cast<std::size_t>(first - trace.time.begin())];
  for (auto it = first; it != last; ++it) {
    const double s = (*it - time) / half_width,
                 y = trace.value[static_cast<std::size_t>(it - trace.time.begin())] - level;
    const Eigen::Vector3d row(1.0, s, 0.5 * s * s);
    normal += row * row.transpose(), right += y * row, square += y * y;
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  const Eigen::Vector3d c = inverse * right;
  if (!c.allFinite()) return {};
  const double rest = std::max(0.0, square - c.dot(right)) / static_cast<double>(count - 3);
  const double spread = inverse(1, 1);
  return LocalFit{level + c[0], c[1] / half_width, c[2] / (half_width * half_width),
                  std::sqrt(rest * spread) / half_width};
}

double medianPeriod(const Trace& trace) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < trace.time.size(); ++i) steps.push_back(trace.time[i] - trace.time[i - 1]);
  return medianOf(steps);
}

template <typename Take>
void forEachTrace(const BoomRecording& recording, const Take& take) {
  for (const Trace& joint : recording.joint)
    if (!joint.time.empty()) take(joint);
  for (const auto& chambers : recording.pressure)
    for (const Trace& trace : chambers) take(trace);
}

bool worksAround(const std::vector<double>& working, double time, double half_width) {
  const auto next = std::lower_bound(working.begin(), working.end(), time - half_width);
  return next != working.end() && *next <= time + half_width;
}

std::optional<BoomPoint> pointAt(const BoomRecording& recording, double time, double half_width) {
  BoomPoint point;
  point.time = time, point.half_width = half_width;
  const auto joints = static_cast<Eigen::Index>(recording.joint.size());
  for (JointVector* v : {&point.motion.position, &point.motion.velocity, &point.motion.acceleration, &point.rate_std})
    v->setZero(joints);
  for (Eigen::Index j = 0; j < joints; ++j) {
    const Trace& trace = recording.joint[static_cast<std::size_t>(j)];
    if (trace.time.empty()) continue;
    const std::optional<LocalFit> fit = fitAround(trace, time, half_width);
    if (!fit) return {};
    point.motion.position[j] = fit->value, point.motion.velocity[j] = fit->rate;
    point.motion.acceleration[j] = fit->acceleration, point.rate_std[j] = fit->rate_std;
  }
  for (std::size_t k = 0; k < recording.pressure.size(); ++k) {
    for (std::size_t chamber = 0; chamber < 2; ++chamber) {
      const std::optional<LocalFit> fit = fitAround(recording.pressure[k][chamber], time, half_width);
      if (!fit) return {};
      point.pressure[k][chamber] = fit->value;
    }
  }
  return point;
}

}  // namespace

void append(const BoomRecording& next, double later, BoomRecording& recording) {
  const auto add = [later](const Trace& from, Trace& to) {
    for (const double time : from.time) to.time.push_back(time + later);
    to.value.insert(to.value.end(), from.value.begin(), from.value.end());
  };
  for (std::size_t j = 0; j < recording.joint.size(); ++j) add(next.joint[j], recording.joint[j]);
  for (std::size_t k = 0; k < recording.pressure.size(); ++k)
    for (std::size_t chamber = 0; chamber < 2; ++chamber)
      add(next.pressure[k][chamber], recording.pressure[k][chamber]);
  for (const double time : next.working) recording.working.push_back(time + later);
}

double endOf(const BoomRecording& recording) {
  double end = 0.0;
  forEachTrace(recording, [&](const Trace& trace) {
    if (!trace.time.empty()) end = std::max(end, trace.time.back());
  });
  return end;
}

BoomPoints pointsOf(const BoomRecording& recording) {
  BoomPoints result;
  double from = -std::numeric_limits<double>::infinity(), to = -from, half_width = kLeastHalfWidth;
  forEachTrace(recording, [&](const Trace& trace) {
    if (trace.time.empty()) return void(to = from);
    from = std::max(from, trace.time.front()), to = std::min(to, trace.time.back());
    half_width = std::max(half_width, 0.5 * static_cast<double>(kLeastReadings) * medianPeriod(trace));
  });
  if (!(to > from) || !std::isfinite(to - from)) return result;
  result.seconds = to - from;
  for (double time = from + half_width; time <= to - half_width; time += half_width) {
    const bool works = worksAround(recording.working, time, half_width);
    std::optional<BoomPoint> point = works ? std::nullopt : pointAt(recording, time, half_width);
    if (point) result.points.push_back(*std::move(point));
    result.left_out += !point;
  }
  return result;
}

}  // namespace hammer_loads::calibration
