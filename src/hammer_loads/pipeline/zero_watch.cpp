#include "hammer_loads/pipeline/zero_watch.h"

#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kSearchShows =
    3.2 * kDegree;  // by the search, negative: on machines with a right zero it shows up to -2.4 deg
constexpr double kSearchShowsAhead = 2.4 * kDegree;  // likewise, positive: up to 0.8 deg
constexpr double kFilterAgrees = 0.8 * kDegree;
constexpr double kAgrees = 1.5;   // consistency of readings and model
constexpr double kOfStep = 0.12;  // of the way between samples: what is seen no better
constexpr double kDeviations = gate::kVeryRare;
constexpr double kFilterShows =
    1.2 * kDegree;  // by the filter, positive: with a right zero it shows up to 0.5 deg, on a light hull 0.9 deg
constexpr double kRefined = 0.5 * kDegree;

}  // namespace

double ZeroWatch::move(double angle) noexcept {
  moved_ += angle;
  settled_ = false;
  search_.restart();
  return angle;
}

double ZeroWatch::follow(const CrankFilter& filter, double reading, double step, const HullMotion& hull) noexcept {
  const Encoder& encoder = filter.encoder();
  if (filter.slips() != slips_) search_.restart(), left_ = false;
  slips_ = filter.slips();
  // A turn without a tool has other times. A zero that is far off may look like one, but not without a contradiction.
  if (filter.state().position.isMirrored() && !(filter.consistency() > kAgrees)) search_.skipTurn();
  search_.setWanted(!agrees(filter));
  const double half_count = encoder.isFiner() ? 0.0 : 0.5 * encoder.resolution();
  search_.add(encoder.place().angle(reading + half_count), step, hull);
  return toMove(filter);
}

/// A filter that explains the readings and shows no error is right: a turn without a tool misleads the search.
bool ZeroWatch::agrees(const CrankFilter& filter) noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  const double shown = errors.estimate()[ConstantErrors::kZero], deviation = errors.deviation()[ConstantErrors::kZero];
  return errors.knows() && filter.consistency() < kAgrees && std::hypot(shown, deviation) < kFilterAgrees;
}

double ZeroWatch::toMove(const CrankFilter& filter) noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  const double shown = errors.estimate()[ConstantErrors::kZero], deviation = errors.deviation()[ConstantErrors::kZero];
  if (search_.evaluations() != evaluations_) {
    evaluations_ = search_.evaluations();
    const auto& found = search_.found();
    const double readings = std::hypot(filter.timingNoise() * filter.state().speed, kOfStep * search_.stepAngle());
    const double least = found && found->error > 0.0 ? kSearchShowsAhead : kSearchShows;
    if (found && !(left_ && found->error < 0.0) &&
        (moved_ == 0.0 || errors.knows() || !(filter.consistency() < kAgrees)) &&
        std::abs(found->error) > std::max(least, kDeviations * std::hypot(found->deviation, readings)))
      return move(found->error);
  }
  if (!errors.knows()) return 0.0;
  const bool is_off = moved_ != 0.0 ? std::abs(shown) > std::max(kRefined, gate::kUsual * deviation)
                                    : shown > std::max(kFilterShows, gate::kRare * deviation);
  if (is_off) return move(shown);
  if (moved_ < 0.0 && moved_ > -kRodLooks) {
    left_ = true;
    return move(-moved_);
  }
  settled_ = true;
  return 0.0;
}

}  // namespace hammer_loads
