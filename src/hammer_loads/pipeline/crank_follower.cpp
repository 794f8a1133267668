#include "hammer_loads/pipeline/crank_follower.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/pipeline/filter_settings.h"
#include "hammer_loads/pipeline/hull_deviation.h"

namespace hammer_loads {
namespace {

constexpr double kBlowSpeed = kCreeping;  // crank speed below which it creeps over the blow and nothing strikes

bool isEarlier(const CrankStep::Passage& passage, Side side) noexcept {
  return (side == Side::kBeforeBlow) == passage.forward;
}

constexpr int kSettlingSamples = 5;  // without measured speeds: until then they are known from linearised steps
constexpr double kSettledDeviations = gate::kRare;       // deviations of the predicted error
constexpr double kFrozenCounts = 5;                      // a crank that turned further gives another angle
constexpr double kSameLateness = 0.3;                    // of the lateness
constexpr double kSurelyPasses = 1.3;                    // counts, for a speed that may be a fifth too large
constexpr double kFrozenDeviations = gate::kImpossible;  // deviations of a sensor's noise
// Limit: kFrozenCounts

/// resolution: of the angle sensor [rad].
double frozenTurn(const PipelineSettings& s, double resolution) noexcept {
  return kFrozenCounts * resolution + kFrozenDeviations * s.crank_angle_noise;
}

CrankSampleGate::Limits limitsOf(const PipelineSettings& s, double resolution) noexcept {
  return {s.max_crank_speed, s.stale_after, frozenTurn(s, resolution), kFrozenDeviations * s.crank_speed_noise};
}

}  // namespace

void CrankStep::forget(const CrankPosition& at) noexcept {
  known_ = false;
  passages_ = 0;
  furthest_blow_ = at.blowsPassed();
  links_ = links_before_ = hammer_loads::linksAt(*model_, at.angle);
}

void CrankStep::set(StampNs start, double length, const CrankPosition& from) noexcept {
  known_ = true;
  start_ = start;
  length_ = length;
  passages_ = 0;
  const CrankPosition now = tracker_->estimate().position;
  links_before_ = links_;
  links_ = hammer_loads::linksAt(*model_, now.angle);
  std::int64_t passed = from.blowsPassed();
  const std::int64_t passed_now = now.blowsPassed();
  for (; passed != passed_now && passages_ < passage_.size(); ++passages_) {
    const bool forward = passed < passed_now;
    const std::int64_t blow = forward ? ++passed : passed--;
    passage_[passages_] = passageOf(blow, forward);
    furthest_blow_ = std::max(furthest_blow_, passed);
  }
}

CrankStep::Passage CrankStep::passageOf(std::int64_t blow, bool forward) const noexcept {
  Passage p;
  p.time = timeOfBlow(blow);
  p.blow = blow;
  p.forward = forward;
  const CrankEstimate before = at(std::max(0.0, p.time - kBlowMargin)),
                      after = at(std::min(length_, p.time + kBlowMargin));
  p.smooth = before.position.isMirrored() || after.position.isMirrored();
  p.speed_before = before.speed;
  p.speed_after = after.speed;
  p.may_strike = forward && !before.position.isMirrored() && blow > furthest_blow_ && p.speed_before >= kBlowSpeed;
  p.strikes = p.may_strike && !p.smooth;
  return p;
}

/// Returns the root of the position by bracketing false position (Illinois).
double CrankStep::timeOfBlow(std::int64_t blow) const noexcept {
  const CrankPosition at_blow{blow, {0.0, Side::kAfterBlow}};
  double low = 0.0, high = length_;
  double f_low = difference(at(low).position, at_blow), f_high = difference(at(high).position, at_blow);
  const double sign = f_high < f_low ? -1.0 : 1.0;  // negative for a crank that turns backward
  f_low *= sign, f_high *= sign;
  constexpr double kAngleTolerance = 1e-11;  // [rad]: some 1e-12 s
  // Numerical: kAngleTolerance
  int kept = 0;  // end that stayed last time: +1 high, -1 low
  for (int i = 0; i < 60 && f_high > kAngleTolerance && f_low < -kAngleTolerance; ++i) {
    const double time = (low * f_high - high * f_low) / (f_high - f_low);
    const double f = sign * difference(at(time).position, at_blow);
    if (f < 0.0) {
      low = time, f_low = f;
      if (kept == 1) f_high *= 0.5;
      kept = 1;
    } else {
      high = time, f_high = f;
      if (kept == -1) f_low *= 0.5;
      kept = -1;
    }
  }
  return f_high <= -f_low ? high : low;
}

double CrankStep::timeAtSide(const Passage& passage, Side side) const noexcept {
  return isEarlier(passage, side) ? std::max(0.0, passage.time - kBlowMargin) : passage.time + kBlowMargin;
}

CrankEstimate CrankStep::atSide(const Passage& passage, Side side) const noexcept {
  CrankEstimate estimate = at(timeAtSide(passage, side));
  estimate.position = {passage.blow, {0.0, side}};
  estimate.speed = isEarlier(passage, side) ? passage.speed_before : passage.speed_after;
  return estimate;
}

double CrankStep::timeDeviation(const Passage& passage) const noexcept {
  const CrankUncertainty there = tracker_->uncertaintyBetween(timeAtSide(passage, Side::kBeforeBlow), 1.0);
  return std::sqrt(there.covariance()(CrankUncertainty::kAngle, CrankUncertainty::kAngle)) /
         std::abs(passage.speed_before);
}

std::optional<CrankPaths> CrankStep::pathsAtSide(const Passage& passage, Side side) const noexcept {
  std::optional<CrankPaths> paths = tracker_->pathsBetween(timeAtSide(passage, side));
  if (paths) paths->forward.position = paths->back.position = {passage.blow, {0.0, side}};
  return paths;
}

CrankFollower::CrankFollower(const HullModel& model, const PipelineSettings& settings)
    : model_(&model),
      settings_(settings),
      unit_check_(settings.max_crank_speed, settings.crank_sensor.gain()),
      latency_(static_cast<StampNs>(std::llround(settings.crank_latency / kSecondsPerNs))),
      sequence_(settings.crank_stamps, settings.stale_after),
      tracker_(std::make_unique<CrankFilter>(ShaftModel(model.mechanism(), settings.level),
                                             model.mechanism().parameters().drive_inertia,
                                             filterSettings(model.mechanism(), settings))),
      gate_(limitsOf(settings, tracker_->angleResolution())),
      step_(*tracker_, model) {}

void CrankFollower::checkUnit(StampNs stamp, const CrankSample& measured) noexcept {
  unit_check_.add(last_raw_stamp_ ? seconds(stamp - *last_raw_stamp_) : 0.0, measured.angle, measured.speed);
  last_raw_stamp_ = stamp;
}

std::optional<Refusal> CrankFollower::otherUnit() const noexcept {
  if (!unit_check_.isOtherUnit()) return std::nullopt;
  if (isOfAngle(unit_check_.unit())) return Refusal::kAngleUnit;
  return unit_check_.unit() == CrankUnit::kDegrees ? Refusal::kDegrees : Refusal::kSpeedUnit;
}

StampSequence::Repeats CrankFollower::repeatsOf(const CrankSample& measured) const noexcept {
  using Repeats = StampSequence::Repeats;
  if (measured.angle != last_raw_.angle || measured.speed != last_raw_.speed) return Repeats::kNo;
  return measured.speed.value_or(0.0) != 0.0 || passesCounts() ? Repeats::kAtWork
         : turns()                                             ? Repeats::kWithinCount
                                                               : Repeats::kAtRest;
}

/// Returns true if the crank passes more than an encoder count between two samples, so that no sensor repeats an angle.
bool CrankFollower::passesCounts() const noexcept {
  if (!turns() || !sequence_.fit().isKnown()) return false;
  return std::abs(estimate_.speed) * 1e-9 * sequence_.fit().interval() > kSurelyPasses * tracker_->angleResolution();
}

bool CrankFollower::turns() const noexcept { return tracker_->hasSpeed() && std::abs(estimate_.speed) > kSlowCrank; }

/// Finds the instant of the sample by its place in the sequence of arrival.
std::optional<Refusal> CrankFollower::place(StampNs header, const CrankSample& measured) noexcept {
  stamp_ = header;
  if (header < 0 || header > kLastStamp) return Refusal::kBadStamp;
  if (const auto refusal = gate_.refusalOf(measured)) {
    checkUnit(header, measured);
    return refusal == Refusal::kImplausible ? otherUnit().value_or(*refusal) : refusal;
  }
  const StampSequence::Place place = sequence_.place(header - latency_, repeatsOf(measured));
  last_raw_ = measured;
  stamp_ = place.stamp;
  if (place.kind == StampSequence::Kind::kDuplicate) return Refusal::kDuplicate;
  if (place.kind == StampSequence::Kind::kOutOfOrder) return Refusal::kOutOfOrder;
  return std::nullopt;
}

std::optional<Refusal> CrankFollower::judge(StampNs header, const CrankSample& measured) noexcept {
  if (const auto refusal = place(header, measured)) return refusal;
  measured_ = measured;
  checkUnit(header, measured);
  verdict_ = gate_.judge(stamp_, measured);
  if (gate_.angleIsFrozen()) task_.repeat(stamp_);
  return verdict_.refusal ? verdict_.refusal : otherUnit();
}

CrankFollower::Outcome CrankFollower::update(const HullMotion& hull) noexcept {
  const CrankSample sample{measured_.angle, verdict_.speed_is_dead ? std::nullopt : measured_.speed};
  tracker_->setHullMotion(hull);
  tracker_->setClock(sequence_.clock());
  tracker_->setLatencyDeviation(stampsOff());
  if (verdict_.order == CrankSampleGate::Order::kFirst) {
    tracker_->start(sample, sequence_.errorBeforeRestart());
    restart();
    speed_measured_ = sample.speed.has_value();
    return Outcome::kBegan;
  }
  const Tracking tracking = tracker_->update(verdict_.step, sample);
  followStamp();
  sequence_.confirm(tracker_->countsIntervals());
  followLostTime();
  if (tracking == Tracking::kOutlier) return Outcome::kRefused;
  if (tracking != Tracking::kContinued) {
    restart();
    speed_measured_ = false;
    return tracking == Tracking::kRevised ? Outcome::kRevised : Outcome::kRestarted;
  }
  estimate_ = tracker_->estimate();
  step_.set(*gate_.last(), verdict_.step, last_position_);
  return Outcome::kContinued;
}

/// Counts a late stamp whose angle was read in time. The angle is then behind by the lateness of the stamp.
void CrankFollower::followStamp() noexcept {
  const double late = sequence_.lateness(), off = tracker_->instantOff();
  if (late > 0.0 && std::abs(off + late) < kSameLateness * late) sequence_.countLate();
  if (turns()) task_.add(stamp_, off);
}

/// Returns the standard deviation of the common shift of all stamps [s]. A reading by a controller's task is half a
/// period old on average and may be a mean of several readings. A given latency contains both.
double CrankFollower::stampsOff() const noexcept {
  const double age = latency_ > 0 ? task_.period() / std::sqrt(12.0) : task_.period();
  return std::hypot(0.5 * sequence_.rounding(), age);
}

/// Corrects the length of the step where readings determine it better than jittering stamps do.
void CrankFollower::followLostTime() noexcept {
  if (tracker_->slips() > slips_) slipped_ = stamp_;
  slips_ = tracker_->slips();
  const double lost = tracker_->lostTime();
  // Single stamps show a lost or surplus sample only some ten samples later. The crank has made up for it by then, so
  // that the step between the two instants is wrong, not the later instant.
  const bool was_made_up =
      sequence_.fit().inBursts() ? lost > 0.0 && sequence_.fit().movedBack() : lost < 0.0 || sequence_.isCrowded();
  if (lost == 0.0 || was_made_up) return;
  stamp_ = sequence_.skip(lost);
  verdict_.step += lost;
}

void CrankFollower::inflateByRod(const CrankAngle& angle, double speed) noexcept {
  tracker_->inflateByRod(CrankAngle::wrapToPi(angle.offset - estimate_.position.angle.offset), speed - estimate_.speed);
}

void CrankFollower::hullMoved(const HullMotion& hull) noexcept {
  tracker_->setHullMotion(hull);
  estimate_ = tracker_->estimate();
}

void CrankFollower::accept() noexcept {
  gate_.accept(stamp_, measured_);
  gate_.setFrozenTurn(frozenTurn(settings_, tracker_->angleResolution()));
  last_position_ = estimate_.position;
}

void CrankFollower::restart() noexcept {
  estimate_ = tracker_->estimate();
  step_.forget(estimate_.position);
  unsettled_ = true;
  samples_since_restart_ = 0;
}

/// Before the first whole revolution there is no peak for comparison. Then only the speed must be known.
bool CrankFollower::isSettled(const HullMotion& hull, double peak_force) noexcept {
  if (!tracker_->isPlausible() || suspectsUnit()) return false;
  if (!unsettled_) return true;
  if (!tracker_->hasSpeed()) return false;
  if (peak_force > 0.0 && ++samples_since_restart_ < kSettlingSamples && !speed_measured_) return false;
  if (peak_force > 0.0) {
    const double deviation =
        hullDeviation(*model_, {}, estimate_, hull, tracker_->uncertainty(1.0).covariance()).wrench().force_z;
    if (kSettledDeviations * deviation > settings_.withhold_above * peak_force) return false;
  }
  unsettled_ = false;
  return true;
}

}  // namespace hammer_loads
