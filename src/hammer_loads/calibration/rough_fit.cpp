#include "hammer_loads/calibration/rough_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads::calibration {
namespace {

constexpr std::size_t kFew = 8;     // blows
constexpr double kApart = 0.1;      // of a stiffness's logarithm: another frequency
constexpr double kMostWorse = 1.1;  // of the residuals' squares: by few blows it may be the better one

/// Where a fit settled; the angles' squared residuals and their count.
struct Settled {
  JointFit fit;
  double squares{}, count{};
  double mean() const { return count > 0.0 ? squares / count : std::numeric_limits<double>::infinity(); }
};

Settled settledFrom(const Globals& start, const std::vector<BlowSegment>& segments, const SegmentModel& model,
                    const Noise& noise, const Free& free, const Progress& progress) {
  Settled s{fitJointly(segments, model, start, noise, free, progress)};
  for (const SegmentFit& one : s.fit.fits)
    for (const ResidualAt& r : one.residuals(model, s.fit.globals, s.fit.noise))
      s.squares += square(r.angle), ++s.count;
  return s;
}

/// By a few blows: the best one, and the best one of another frequency where that is nearly as good.
std::vector<Globals> startsBeside(const Globals& guess, const std::vector<BlowSegment>& segments,
                                  const SegmentModel& model, const Noise& noise, const Free& free,
                                  const Progress& progress) {
  std::vector<BlowSegment> few;
  for (std::size_t i = 0; i < segments.size(); i += std::max<std::size_t>(1, segments.size() / kFew))
    few.push_back(segments[i]);
  std::vector<Settled> found;
  for (int i = 0; i < 15; ++i) {
    Globals start = guess;
    start[kZero] += 10.0 * kDegree * (i / 3 - 2);
    start[kLogCoupling] = (i % 3 - 1) * model.coupling->stiffness_deviation;
    found.push_back(settledFrom(start, few, model, noise, free, piece(progress, i / 15.0, (i + 1) / 15.0)));
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.mean() < b.mean(); });
  std::vector<Globals> starts{found.front().fit.globals};
  for (const Settled& one : found) {
    const double apart = one.fit.globals[kLogCoupling] - starts.front()[kLogCoupling];
    if (starts.size() == 1 && std::abs(apart) > kApart && one.mean() < kMostWorse * found.front().mean())
      starts.push_back(one.fit.globals);
  }
  return starts;
}

}  // namespace

RoughFit fitRoughly(const std::vector<BlowSegment>& segments, const SegmentModel& model, const Globals& guess,
                    const Noise& noise, const Free& free, const Progress& progress) {
  if (!model.coupling) return {fitJointly(segments, model, guess, noise, free, progress)};
  const std::vector<Globals> starts = startsBeside(guess, segments, model, noise, free, piece(progress, 0.0, 0.5));
  Settled best = settledFrom(starts.front(), segments, model, noise, free, piece(progress, 0.5, 0.75));
  if (starts.size() == 1) return {best.fit};
  Settled other = settledFrom(starts.back(), segments, model, noise, free, piece(progress, 0.75, 1.0));
  if (other.mean() < best.mean()) std::swap(best, other);
  const double worse = best.count * (other.mean() / best.mean() - 1.0);
  const bool as_good = worse < square(gate::kVeryRare);
  return {best.fit, as_good ? Globals(other.fit.globals - best.fit.globals) : Globals(Globals::Zero())};
}

}  // namespace hammer_loads::calibration
