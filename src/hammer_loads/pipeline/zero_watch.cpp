#include "hammer_loads/pipeline/zero_watch.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kSearchShows =
    3.2 * kDegree;  // negative error shown by the search: with a correct zero up to -2.4 deg
constexpr double kSearchShowsAhead =
    2.4 * kDegree;  // positive error shown by the search: with a correct zero up to 0.8 deg
constexpr double kFilterAgrees = 0.8 * kDegree;
constexpr double kAgrees = 1.5;   // consistency of readings and model
constexpr double kOfStep = 0.08;  // part of the rotation between samples: resolution of the search
constexpr double kDeviations = gate::kVeryRare;
constexpr double kFilterShows =
    1.2 * kDegree;  // positive error shown by the filter: with a correct zero up to 0.5 deg, on a light hull 0.9 deg
constexpr double kSearchErrs = 3.2 * kDegree,  // largest error of the search, also at 100 Hz
    kSearchErrsAhead = 1.5 * kDegree;
constexpr double kSearchDeviation = 2.0 * kDegree;  // standard deviation
constexpr double kCountsAhead = 0.8 * kDegree;      // shown by the filter: a zero 3 deg off may look like 1 deg
constexpr int kTurnsToSearch = 8;                   // of a machine whose times no zero explains
constexpr int kTurnsToShow = 20;                    // readings and model that agree for so long outweigh the search
constexpr double kRefined = 0.5 * kDegree;

/// Returns the consistency of readings and model without the part that an elastic rod explains. Such a rod contradicts
/// the model just after the blow, a wrong zero elsewhere as well.
double consistencyBesideRod(const CrankFilter& filter) noexcept {
  const RodEvidence& rod = filter.rodEvidence();
  return rod.showsElasticRod() ? std::max(rod.later(), filter.strikeConsistency()) : filter.consistency();
}

}  // namespace

double ZeroWatch::move(double angle, double deviation) noexcept {
  moved_ += angle;
  deviation_ = deviation;
  settled_ = false;
  search_.restart();
  return angle;
}

double ZeroWatch::follow(const CrankFilter& filter, bool rod_explains, double reading, double step,
                         const HullMotion& hull) noexcept {
  const Encoder& encoder = filter.encoder();
  if (filter.slips() != slips_) search_.restart(), left_ = false;
  slips_ = filter.slips();
  // A blank firing has a different time course. A zero that is far off may imitate it, but contradicts the model.
  if (filter.state().position.isMirrored() && !(filter.consistency() > kAgrees)) search_.skipTurn();
  search_.setWanted(filter.constantErrors().turns() < kTurnsToSearch || !agrees(filter));
  const double half_count = encoder.isFiner() ? 0.0 : 0.5 * encoder.resolution();
  search_.add(encoder.place().angle(reading + half_count), step, hull);
  return toMove(filter, rod_explains);
}

/// Returns true if the filter agrees with the readings and shows no error. It then takes precedence, since a blank
/// firing misleads the search.
bool ZeroWatch::agrees(const CrankFilter& filter) noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  const double shown = errors.estimate()[ConstantErrors::kZero], deviation = errors.deviation()[ConstantErrors::kZero];
  return errors.isKnown() && consistencyBesideRod(filter) < kAgrees && std::hypot(shown, deviation) < kFilterAgrees;
}

bool ZeroWatch::contradicts(const CrankFilter& filter) const noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  const bool agrees = filter.consistency() < kAgrees;
  const auto& found = search_.found();
  if (!found) return !agrees || errors.turns() < kTurnsToSearch;
  if (agrees && errors.turns() > kTurnsToShow) return false;
  const double more = found->error - errors.estimate()[ConstantErrors::kZero];
  return more < -kSearchErrs || more > kSearchErrsAhead;
}

ZeroWatch::Stated ZeroWatch::stated(const CrankFilter& filter) const noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  const auto& found = search_.found();
  if (moved_ != 0.0 && !settled_) return {moved_, deviation_};
  if (!errors.isKnown() || (found && contradicts(filter)))
    return {moved_ + (found ? found->error : 0.0), kSearchDeviation};
  const double shown = errors.estimate()[ConstantErrors::kZero];
  Eigen::Vector4d deviations(errors.deviation()[ConstantErrors::kZero], errors.zeroNotLinear(), 0.0, 0.0);
  if (filter.rodEvidence().showsElasticRod()) deviations[2] = ConstantErrors::kRodHides;
  // The linear estimate saturates: if it does not explain the readings, the difference from the search is a part of the
  // deviation.
  if (!(filter.consistency() < kAgrees)) deviations[3] = found ? found->error - shown : ConstantErrors::kUnknownZero;
  return {moved_ + shown, deviations.norm()};
}

bool ZeroWatch::mayCount(const CrankFilter& filter) const noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  if (errors.zeroIsGiven()) return true;
  if (!errors.zeroIsShown() || errors.turns() < kTurnsToSearch) return false;
  if (errors.estimate()[ConstantErrors::kZero] > kCountsAhead) return false;
  // An elastic rod causes an apparent error of up to 3 deg, and calibrate cannot separate it from the zero.
  return filter.rodEvidence().showsElasticRod() || std::max(errors.zeroDeviation(), stated(filter).deviation) < kMost;
}

double ZeroWatch::toMove(const CrankFilter& filter, bool rod_explains) noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  const double shown = errors.estimate()[ConstantErrors::kZero], deviation = errors.deviation()[ConstantErrors::kZero];
  if (search_.evaluations() != evaluations_) {
    evaluations_ = search_.evaluations();
    const auto& found = search_.found();
    const double readings = std::hypot(filter.timingNoise() * filter.state().speed, kOfStep * search_.stepAngle());
    const double least = found && found->error > 0.0 ? kSearchShowsAhead : kSearchShows;
    // Friction in the pins of an elastic rod misleads the search by up to 14 deg.
    const bool right =
        filter.rodEvidence().showsElasticRod() &&
        (rod_explains || agrees(filter) || (!errors.isKnown() && consistencyBesideRod(filter) < kAgrees));
    if (found && !(left_ && found->error < 0.0) && !right &&
        (moved_ == 0.0 || errors.isKnown() || !(filter.consistency() < kAgrees)) &&
        std::abs(found->error) > std::max(least, kDeviations * std::hypot(found->deviation, readings)))
      return move(found->error, kSearchDeviation);
  }
  if (!errors.isKnown()) return 0.0;
  const bool is_off = moved_ != 0.0 ? std::abs(shown) > std::max(kRefined, gate::kUsual * deviation)
                                    : shown > std::max(kFilterShows, gate::kRare * deviation);
  if (is_off) return move(shown, stated(filter).deviation);
  if (moved_ < 0.0 && moved_ > -kRodLooks) {
    left_ = true;
    return move(-moved_, kRodLooks);
  }
  settled_ = true;
  return 0.0;
}

}  // namespace hammer_loads
