#include "hammer_loads/calibration/crank_recording.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kRounding = 2e-6;   // rounding of a step between readings in single precision [rad]
constexpr double kGap = 4.5;         // periods without a sample: what lies between is not known
constexpr double kDisorder = 0.005;  // part of the stamps that repeat or change places, from which on they are re-timed
constexpr std::size_t kRetimeHalfWidth = 200;   // samples on either side that show a sample's own time
constexpr double kHalfSegment = 3.05;           // [rad] on either side of the blow
constexpr double kLeastSpeed = 3.0;             // [rad/s] at the blow: a slower one is no working turn
constexpr std::size_t kLeastPoints = 5;         // on either side of the blow
constexpr double kLargestStep = 0.35 * kTwoPi;  // [rad] between samples

/// Largest number of which both are multiples (Euclid, with nearest remainders).
double commonPart(double a, double b) {
  double large = std::max(a, b), small = std::min(a, b);
  while (small > 0.0) {
    const double rest = std::abs(large - small * std::nearbyint(large / small));
    large = small;
    small = rest < std::max(kRounding, kCountTolerance * small) ? 0.0 : rest;
  }
  return large;
}

/// Number of counts per revolution by the common divisor of all steps between readings; 0 when there is none above the
/// finest.
double commonCount(const std::vector<RecordedSample>& samples) {
  double common = 0.0, most = 1.0;  // multiples: the more of them a step has, the better it shows the count
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = std::abs(CrankAngle::wrapToPi(samples[i].reading - samples[i - 1].reading));
    if (step < 0.1 * kFinestCount) continue;
    const double multiples = common > 0.0 ? std::nearbyint(step / common) : 0.0;
    const bool fits =
        multiples >= 1.0 && std::abs(step - multiples * common) < std::min(0.1 * common, kRounding * (multiples + 1.0));
    if (fits && multiples > most) common = step / multiples, most = multiples;
    if (fits) continue;
    common = common == 0.0 ? step : commonPart(common, step);
    most = 1.0;
    if (common < (1.0 - kCountTolerance) * kFinestCount) return 0.0;
  }
  return common > 0.0 && common < 0.25 * kTwoPi ? kTwoPi / std::nearbyint(kTwoPi / common) : 0.0;
}

std::size_t dropUseless(std::vector<RecordedSample>& samples) {
  std::vector<RecordedSample> good;
  for (const RecordedSample& s : samples) {
    const bool finite = std::isfinite(s.reading) && std::abs(s.reading) < 1e9 && std::isfinite(s.time);
    const bool twice =
        !good.empty() && s.time == good.back().time && s.reading == good.back().reading && s.speed == good.back().speed;
    if (finite && !twice) good.push_back(s);
  }
  const std::size_t refused = samples.size() - good.size();
  samples = std::move(good);
  return refused;
}

/// Mean step of a recording whose single steps give no information.
double meanPeriod(const std::vector<RecordedSample>& samples) {
  std::vector<double> means;
  constexpr std::size_t kStride = 40;
  for (std::size_t i = kStride; i < samples.size(); i += kStride / 4)
    means.push_back((samples[i].time - samples[i - kStride].time) / static_cast<double>(kStride));
  return medianOf(means);
}

/// Line through the neighbours' stamps over their place in the sequence, between gaps.
void retimeRun(std::vector<RecordedSample>& samples, std::size_t begin, std::size_t end) {
  std::vector<double> times;
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t low = i > begin + kRetimeHalfWidth ? i - kRetimeHalfWidth : begin;
    const std::size_t high = std::min(end, i + kRetimeHalfWidth + 1);
    double n = 0.0, x = 0.0, t = 0.0, xx = 0.0, xt = 0.0;
    for (std::size_t j = low; j < high; ++j) {
      const double place = static_cast<double>(j) - static_cast<double>(i), time = samples[j].time - samples[i].time;
      n += 1.0, x += place, t += time, xx += place * place, xt += place * time;
    }
    const double spread = n * xx - x * x;
    times.push_back(samples[i].time + (spread > 0.0 ? (t * xx - x * xt) / spread : 0.0));
  }
  for (std::size_t i = begin; i < end; ++i) samples[i].time = times[i - begin];
}

bool isDisordered(const std::vector<RecordedSample>& samples) {
  std::size_t disordered = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) disordered += samples[i].time <= samples[i - 1].time;
  return static_cast<double>(disordered) > kDisorder * static_cast<double>(samples.size());
}

std::vector<std::size_t> startsOf(const std::vector<RecordedSample>& samples, double longest_step) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == 0 || samples[i].time - samples[i - 1].time > longest_step) starts.push_back(i);
  }
  return starts;
}

/// The stamps' own times where they are in order, else equal intervals by sequence.
void orderTimes(std::vector<RecordedSample>& samples, CrankTrack& track) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].time - samples[i - 1].time);
  track.facts.retimed = isDisordered(samples);
  track.facts.period = track.facts.retimed ? meanPeriod(samples) : medianOf(steps);
  if (track.facts.retimed) {
    std::vector<double> long_steps;  // a burst's own step is no gap
    std::sort(steps.begin(), steps.end());
    const double usual = steps[steps.size() - 1 - steps.size() / 100];
    track.starts = startsOf(samples, std::max(kGap * track.facts.period, 1.5 * usual));
    for (std::size_t i = 0; i < track.starts.size(); ++i)
      retimeRun(samples, track.starts[i], i + 1 < track.starts.size() ? track.starts[i + 1] : samples.size());
    for (std::size_t i = 1; i < samples.size(); ++i)
      samples[i].time = std::max(samples[i].time, samples[i - 1].time + 1e-9);
    return;
  }
  std::vector<RecordedSample> in_order;  // single stamps that went back
  for (const RecordedSample& s : samples) {
    if (in_order.empty() || s.time > in_order.back().time) in_order.push_back(s);
  }
  track.facts.refused += samples.size() - in_order.size();
  samples = std::move(in_order);
  track.starts = startsOf(samples, kGap * track.facts.period);
}

}  // namespace

CrankTrack trackOf(std::vector<RecordedSample> samples, double ratio) {
  CrankTrack track;
  track.facts.refused = dropUseless(samples);
  if (samples.size() < 2) return track;
  track.facts.count = commonCount(samples);
  orderTimes(samples, track);
  const bool wraps = ratio == 1.0;
  double turned = 0.0, forward = 0.0;
  std::size_t next_start = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool starts = next_start < track.starts.size() && track.starts[next_start] == i;
    next_start += starts;
    const double step = i == 0 ? 0.0 : samples[i].reading - samples[i - 1].reading;
    const double change = wraps ? CrankAngle::wrapToPi(step) : step;
    turned = i == 0 ? samples[0].reading : turned + change;
    if (!starts) forward += change;
    track.points.push_back({samples[i].time, turned, samples[i].speed, samples[i].gravity});
  }
  track.direction = forward < 0.0 ? -1 : 1;
  const double gain = track.direction / ratio;
  for (CrankPoint& point : track.points) {
    point.seen = gain * (point.seen + 0.5 * track.facts.count);
    if (point.speed) *point.speed *= gain;
  }
  return track;
}

std::vector<BlowSegment> cutAtBlows(const CrankTrack& track, double zero) {
  std::vector<BlowSegment> segments;
  BlowSegment segment;
  double turn = 0.0;
  std::size_t next_start = 0;
  const auto finish = [&] {
    const auto& p = segment.points;
    const auto before = std::count_if(p.begin(), p.end(), [&](const CrankPoint& at) { return at.seen < zero; });
    const auto after = static_cast<std::ptrdiff_t>(p.size()) - before;
    bool good =
        before >= static_cast<std::ptrdiff_t>(kLeastPoints) && after >= static_cast<std::ptrdiff_t>(kLeastPoints);
    for (std::size_t i = 1; good && i < p.size(); ++i) {
      const double step = p[i].seen - p[i - 1].seen;
      good = step > -0.02 && step < kLargestStep;
    }
    const double whole = 2.0 * kHalfSegment;
    good = good && p.back().seen - p.front().seen > 0.75 * whole;
    if (good) {  // over some 0.3 rad around the blow
      const auto at = static_cast<std::size_t>(before);
      std::size_t low = at, high = at;
      while (low > 0 && p[low].seen > zero - 0.15) --low;
      while (high + 1 < p.size() && p[high].seen < zero + 0.15) ++high;
      good = (p[high].seen - p[low].seen) > kLeastSpeed * (p[high].time - p[low].time);
    }
    if (good) {
      for (const CrankPoint& at : p) segment.gravity.x += at.gravity.x, segment.gravity.z += at.gravity.z;
      segment.gravity.x /= static_cast<double>(p.size());
      segment.gravity.z /= static_cast<double>(p.size());
      segments.push_back(segment);
    }
    segment = BlowSegment{};
  };
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    const bool starts = next_start < track.starts.size() && track.starts[next_start] == i;
    next_start += starts;
    CrankPoint point = track.points[i];
    const double own_turn = std::nearbyint((point.seen - zero) / kTwoPi);
    if (!segment.points.empty() && (starts || own_turn != turn)) finish();
    turn = own_turn;
    point.seen -= kTwoPi * turn;
    if (std::abs(point.seen - zero) <= kHalfSegment) segment.points.push_back(point);
  }
  if (!segment.points.empty()) finish();
  return segments;
}

}  // namespace hammer_loads::calibration
