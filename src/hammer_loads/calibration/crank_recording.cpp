#include "hammer_loads/calibration/crank_recording.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/linkage/crank_motion.h"
#include "hammer_loads/util/median.h"

namespace hammer_loads::calibration {
namespace {

constexpr double kRounding = 2e-6;              // rounding of a step between readings in single precision [rad]
constexpr double kGap = 4.5;                    // periods without a sample; the motion in a gap is unknown
constexpr double kDisorder = 0.005;             // part of repeated or swapped stamps above which all are re-timed
constexpr std::size_t kRetimeHalfWidth = 200;   // samples on either side that determine a sample's time
constexpr double kHalfSegment = 3.05;           // [rad] on either side of the blow
constexpr double kLeastSpeed = 3.0;             // [rad/s] at the blow; slower revolutions are not at work
constexpr std::size_t kLeastPoints = 5;         // on either side of the blow
constexpr double kLargestStep = 0.35 * kTwoPi;  // [rad] between samples
// Numerical: kRounding
// Limit: kLeastSpeed, kLeastPoints, kLargestStep

/// Returns the greatest common divisor (Euclid's algorithm with nearest remainders).
double commonPart(double a, double b) {
  double large = std::max(a, b), small = std::min(a, b);
  while (small > 0.0) {
    const double rest = std::abs(large - small * std::nearbyint(large / small));
    large = small;
    small = rest < std::max(kRounding, kCountTolerance * small) ? 0.0 : rest;
  }
  return large;
}

/// Returns the angle of one count from the common divisor of all steps between readings [rad]; 0 if there is none above
/// the finest.
double commonCount(const std::vector<RecordedSample>& samples) {
  double common = 0.0, most = 1.0;  // multiples: a step with more of them determines the count better
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

/// Returns the samples without duplicates and those that are not finite.
std::vector<RecordedSample> usefulOf(const std::vector<RecordedSample>& samples) {
  std::vector<RecordedSample> good;
  for (const RecordedSample& s : samples) {
    const bool finite = std::isfinite(s.reading) && std::abs(s.reading) < 1e9 && std::isfinite(s.time);
    const bool twice =
        !good.empty() && s.time == good.back().time && s.reading == good.back().reading && s.speed == good.back().speed;
    if (finite && !twice) good.push_back(s);
  }
  return good;
}

/// Returns the mean step of a recording whose single steps give no information.
double meanPeriod(const std::vector<RecordedSample>& samples) {
  std::vector<double> means;
  constexpr std::size_t kStride = 40;
  // Numerical: kStride
  for (std::size_t i = kStride; i < samples.size(); i += kStride / 4)
    means.push_back((samples[i].time - samples[i - kStride].time) / static_cast<double>(kStride));
  return medianOf(means);
}

/// Replaces the stamps between gaps by a line through the neighbours' stamps over their place in the sequence.
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

/// Keeps the stamps if they are in order, and replaces them by equal intervals in sequence otherwise. Returns the first
/// samples after gaps, 0 included.
std::vector<std::size_t> orderTimes(std::vector<RecordedSample>& samples, SensorFacts& facts) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].time - samples[i - 1].time);
  facts.retimed = isDisordered(samples);
  facts.period = facts.retimed ? meanPeriod(samples) : medianOf(steps);
  if (facts.retimed) {
    std::sort(steps.begin(), steps.end());
    const double usual = steps[steps.size() - 1 - steps.size() / 100];  // steps between bursts are no gaps
    const std::vector<std::size_t> starts = startsOf(samples, std::max(kGap * facts.period, 1.5 * usual));
    for (std::size_t i = 0; i < starts.size(); ++i)
      retimeRun(samples, starts[i], i + 1 < starts.size() ? starts[i + 1] : samples.size());
    for (std::size_t i = 1; i < samples.size(); ++i)
      samples[i].time = std::max(samples[i].time, samples[i - 1].time + 1e-9);
    return starts;
  }
  std::vector<RecordedSample> in_order;  // without single stamps that go back
  for (const RecordedSample& s : samples) {
    if (in_order.empty() || s.time > in_order.back().time) in_order.push_back(s);
  }
  samples = std::move(in_order);
  return startsOf(samples, kGap * facts.period);
}

/// Returns true if the crank turned forward throughout, with a blow at working speed.
bool isWorkingTurn(const std::vector<CrankPoint>& p, double zero) {
  const auto is_before = [&](const CrankPoint& at) { return at.seen < zero; };
  const auto before = static_cast<std::size_t>(std::count_if(p.begin(), p.end(), is_before));
  if (before < kLeastPoints || p.size() - before < kLeastPoints) return false;
  for (std::size_t i = 1; i < p.size(); ++i) {
    const double step = p[i].seen - p[i - 1].seen;
    if (!(step > -0.02 && step < kLargestStep)) return false;
  }
  if (!(p.back().seen - p.front().seen > 1.5 * kHalfSegment)) return false;
  std::size_t low = before, high = before;  // some 0.3 rad around the blow
  while (low > 0 && p[low].seen > zero - 0.15) --low;
  while (high + 1 < p.size() && p[high].seen < zero + 0.15) ++high;
  return p[high].seen - p[low].seen > kLeastSpeed * (p[high].time - p[low].time);
}

}  // namespace

CrankTrack trackOf(const std::vector<RecordedSample>& recorded, double ratio) {
  CrankTrack track;
  std::vector<RecordedSample> samples = usefulOf(recorded);
  if (samples.size() < 2) return track;
  track.facts.count = commonCount(samples);
  const std::vector<std::size_t> starts = orderTimes(samples, track.facts);
  double turned = samples[0].reading, forward = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double step = i == 0 ? 0.0 : samples[i].reading - samples[i - 1].reading;
    const double change = ratio == 1.0 ? CrankAngle::wrapToPi(step) : step;
    turned += change;
    const bool is_start = std::binary_search(starts.begin(), starts.end(), i);
    if (!is_start) forward += change;
    track.points.push_back({samples[i].time, turned, samples[i].speed, samples[i].gravity, is_start});
  }
  track.facts.direction = forward < 0.0 ? -1 : 1;
  const double gain = track.facts.direction / ratio;
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
  const auto finish = [&] {
    const auto count = static_cast<double>(segment.points.size());
    for (const CrankPoint& at : segment.points) segment.gravity.x += at.gravity.x, segment.gravity.z += at.gravity.z;
    segment.gravity.x /= count, segment.gravity.z /= count;
    if (isWorkingTurn(segment.points, zero)) segments.push_back(segment);
    segment = BlowSegment{};
  };
  for (CrankPoint point : track.points) {
    const double own_turn = std::nearbyint((point.seen - zero) / kTwoPi);
    if (!segment.points.empty() && (point.starts || own_turn != turn)) finish();
    turn = own_turn;
    point.seen -= kTwoPi * turn;
    if (std::abs(point.seen - zero) <= kHalfSegment) segment.points.push_back(point);
  }
  if (!segment.points.empty()) finish();
  return segments;
}

}  // namespace hammer_loads::calibration
