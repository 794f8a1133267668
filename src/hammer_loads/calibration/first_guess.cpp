#include "hammer_loads/calibration/first_guess.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads::calibration {
namespace {

constexpr int kTable = 720;       // places in the turn where the inertia is known
constexpr double kWindow = 0.12;  // [rad] over which a speed is taken
constexpr std::size_t kMostSpeeds = 20000;
constexpr double kLeastMean = 3.0;  // [rad/s]

struct SpeedAt {
  double seen, speed, time;
  bool starts;
};

/// From windows of the readings, between gaps.
std::vector<SpeedAt> speedsOf(const CrankTrack& track) {
  std::vector<SpeedAt> speeds;
  std::size_t begin = 0, next_start = 0;
  bool starts = true;
  for (std::size_t i = 0; i < track.points.size() && speeds.size() < kMostSpeeds; ++i) {
    if (next_start < track.starts.size() && track.starts[next_start] == i) ++next_start, begin = i, starts = true;
    const CrankPoint &a = track.points[begin], &b = track.points[i];
    const double turned = b.seen - a.seen;
    if (std::abs(turned) < kWindow || b.time <= a.time) continue;
    speeds.push_back({0.5 * (a.seen + b.seen), turned / (b.time - a.time), 0.5 * (a.time + b.time), starts});
    begin = i;
    starts = false;
  }
  return speeds;
}

/// Residual variance over total variance of straight lines through the energy over the angle, one per revolution.
double unsteadiness(const std::vector<SpeedAt>& speeds, const std::vector<double>& inertia, double zero,
                    double drive_inertia) {
  double left = 0.0, total = 0.0, n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, last = -1.0;
  const auto finish = [&] {
    const double spread = n * xx - x * x;
    if (n >= 8.0 && spread > 0.0) {
      const double covariance = n * xy - x * y;
      left += (yy - y * y / n) - covariance * covariance / (n * spread);
      total += yy;
    }
    n = x = y = xx = xy = yy = 0.0;
  };
  for (const SpeedAt& s : speeds) {
    const double angle = s.seen - zero, turns = angle / kTwoPi, part = turns - std::floor(turns);
    if (s.starts || std::floor(turns) != last) finish();
    last = std::floor(turns);
    if (s.speed < 1.0) continue;
    const double place = part * kTable;
    const auto low = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kTable - 1));
    const double j = inertia[low] + (place - static_cast<double>(low)) * (inertia[low + 1] - inertia[low]);
    const double energy = 0.5 * (drive_inertia + j) * s.speed * s.speed;
    n += 1.0, x += part, y += energy, xx += part * part, xy += part * energy, yy += energy * energy;
  }
  finish();
  return total > 0.0 ? left / total : 1.0;
}

}  // namespace

std::optional<FirstGuess> firstGuess(const CrankTrack& track, const SegmentModel& model, double drive_inertia) {
  const std::vector<SpeedAt> speeds = speedsOf(track);
  double mean = 0.0;
  for (const SpeedAt& s : speeds) mean += s.speed / static_cast<double>(speeds.size());
  if (speeds.size() < 50 || mean < kLeastMean) return std::nullopt;
  std::vector<double> inertia;
  for (int i = 0; i <= kTable; ++i) {
    const double angle = kTwoPi * i / kTable;
    inertia.push_back(
        model
            .shaft(2 * i < kTable ? CrankAngle{angle, Side::kAfterBlow} : CrankAngle{angle - kTwoPi, Side::kBeforeBlow})
            .inertia);
  }
  FirstGuess best;
  double least = 2.0;
  for (const double factor : {0.4, 0.55, 0.75, 1.0, 1.35, 1.8, 2.5}) {
    for (int degree = 0; degree < 360; degree += 2) {
      const double zero = kTwoPi * degree / 360.0;
      const double left = unsteadiness(speeds, inertia, zero, factor * drive_inertia);
      if (left < least) least = left, best = {zero, factor * drive_inertia};
    }
  }
  return best;
}

}  // namespace hammer_loads::calibration
