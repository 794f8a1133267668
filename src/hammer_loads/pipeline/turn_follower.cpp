#include "hammer_loads/pipeline/turn_follower.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/linkage/blow_inertia.h"
#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kRingPart = 5e-4;  // [s] between points while a rod vibrates; a parabola gives its peak
// Numerical: kRingPart
constexpr double kBlind = 3e-3;  // [s], measured on swinging hulls: a shorter torque looks like part of the blow
// Prior: kBlind

}  // namespace

void TurnFollower::restart() noexcept {
  turn_.abandon();
  peak_ = {};
  last_blow_.reset();
}

void TurnFollower::discard() noexcept {
  if (pending_.isWaiting()) --turns_;
  pending_.drop();
  restart();
}

TurnInstant TurnFollower::instant(double time, const CrankEstimate& crank) const noexcept {
  const CrankMotion motion = motionOf(crank);
  const LinkMotion links = step_->linksAt(motion.angle);
  const HullWrench added = frameWrench(*model_, links, motion.speed, hull_);
  return {time, hullWrench(*model_, links, motion, hull_), linkMomentum(*model_, links, motion.angle, motion.speed),
          added.force_x, added.force_z};
}

/// Returns the instant while the rod's spring is followed. origin: time of the step's start [s].
TurnInstant TurnFollower::ringing(double origin, double time) const noexcept {
  const DriveReaction drive = driveReaction(*model_, tracker_->driveInertia());
  const ElasticFollower::Instant there = elastic_->byBodies(time, drive, hull_);
  const HullWrench momentum = elastic_->momentum(there.bodies, there.links, drive).all;
  const HullWrench added = frameWrench(*model_, there.links, there.crank.speed, hull_);
  return {origin + time,
          there.wrench,
          {momentum.force_x, momentum.force_z, momentum.torque_y},
          added.force_x,
          added.force_z};
}

/// Returns the time between points [s]. Pins with joint clearance touch for a few tenths of a millisecond.
double TurnFollower::partOfStep(bool rings) const noexcept {
  if (!rings) return kPulseStep;
  return elastic_->filter().motion().rod.play > 0.0 ? kRingStep : kRingPart;
}

/// Records points of the revolution in (from, to] [s] after the step's start.
void TurnFollower::recordTo(double from, double to) noexcept {
  if (!turn_.recording() || !(to > from)) return;
  const double origin = seconds(step_->start() - epoch_);
  const bool rings = elastic_->ranOverStep();
  const int count = partsOf(to - from, partOfStep(rings));
  for (int i = 1; i <= count; ++i) {
    const double time = i == count ? to : from + (to - from) * i / count;
    const TurnInstant point = rings ? ringing(origin, time) : instant(origin + time, step_->at(time));
    turn_.add(point);
    peak_.of_step = std::max(peak_.of_step, point.wrench.force_z);
    double& part = rings ? peak_.of_ring : peak_.of_strike;
    part = std::max(part, point.wrench.force_z);
  }
}

/// Counts backward passages minus the forward ones, since a crank that swings at the dead centre passes it both ways.
void TurnFollower::countBackward(const CrankStep::Passage& passage) noexcept {
  if (!passage.forward) ++backward_;
  if (passage.forward && !passage.may_strike && backward_ > 0) --backward_;
}

void TurnFollower::follow(const HullMotion& hull, SampleResult& result) noexcept {
  hull_ = hull;
  peak_.of_step = 0.0;
  double from = 0.0;
  for (const CrankStep::Passage& passage : *step_) {
    if (!passage.forward) turn_.abandon();
    countBackward(passage);
    if (!passage.may_strike) continue;
    recordTo(from, std::max(from, passage.time - kBlowMargin));
    finishBlow(result);
    if (run_up_)
      endTurn(passage);
    else
      restart();  // the speeds at the blow are too uncertain to be published
    from = passage.time + kBlowMargin;
  }
  recordTo(from, step_->length());
  if (pending_.isWaiting()) pending_.follow(tracker_->blowFactor());
  const double now = seconds(step_->start() - epoch_) + step_->length();
  if (pending_.isMeasured(now, result.crank.position)) finishBlow(result);
}

void TurnFollower::trackErrors(const SampleResult& result) noexcept {
  const CrankEstimate& crank = result.crank;
  if (errors_.rises(result.wrench.force_z))
    errors_.rose(result.stamp, momentumColumns(*columns_, *model_, crank.position.angle, crank.speed,
                                               result.uncertainty.speedAtAngle(crank.acceleration / crank.speed)));
  const SampleResult::OfExtreme extreme = result.ofExtreme();
  errors_.sample(result.wrench.force_z, extreme.deviation.force_z, result.deviation.common().force_z,
                 extreme.ring.force_z, result.load_columns);
}

/// Ends the pulse. by_readings: covariance of the crank without the part of an elastic rod.
void TurnFollower::endPulse(const TurnInstant& at, const CrankEstimate& before, const CrankUncertainty& uncertainty,
                            const Eigen::Matrix3d& by_readings, TurnEnd& end) noexcept {
  end.pulse = turn_.end(at);
  const auto [published, withheld, of_step, of_strike, of_ring] = std::exchange(peak_, {});
  if (withheld > std::max(published, of_step)) end.pulse.reset();
  if (!end.pulse) return;
  const bool is_rings = of_ring > of_strike;
  peak_force_ = is_rings && of_strike > 0.0 ? of_strike : end.pulse->amplitude;
  const LinksForGradient links(*model_, linksAt(*model_, before.position.angle));
  const DriveReaction drive = driveReaction(*model_, tracker_->driveInertia());
  const MomentumColumns columns = momentumColumns(*columns_, *model_, before.position.angle, before.speed,
                                                  uncertainty.speedAtAngle(before.acceleration / before.speed));
  end.pulse_errors = errors_.end(end.stamp, *end.pulse,
                                 {momentumDeviation(*model_, drive, before, links, uncertainty.own),
                                  momentumDeviation(*model_, drive, before, links, by_readings)},
                                 columns, weightColumns(*columns_, *model_, hull_.gravity));
  if (is_rings) errors_.addPeakBetween(end.pulse->amplitude, end.pulse_errors.amplitude);
}

/// Ends the revolution; the blow is measured later.
void TurnFollower::endTurn(const CrankStep::Passage& passage) noexcept {
  TurnEnd& end = pending_end_;
  end = {};
  end.stamp = step_->stampAt(passage.time);
  end.turn = ++turns_;
  const double time = seconds(step_->start() - epoch_) + passage.time;
  CrankEstimate before = step_->atSide(passage, Side::kBeforeBlow);
  if (elastic_->runs()) before.speed = elastic_->strikingSpeed();
  CrankUncertainty uncertainty = tracker_->uncertaintyBetween(std::max(0.0, passage.time - kBlowMargin), 1.0);
  const Eigen::Matrix3d by_readings = uncertainty.own;
  if (!elastic_->runs())
    uncertainty.own(CrankUncertainty::kSpeed, CrankUncertainty::kSpeed) += square(rod_->lackingSpeed());
  const double rate = before.acceleration / before.speed;
  endPulse(instant(time, before), before, uncertainty, by_readings, end);
  errors_.begin(end.stamp);
  end.mean_hold_down_force =  // multiplied by the impulse once that is known
      last_blow_ ? 1.0 / seconds(end.stamp - *last_blow_) : std::numeric_limits<double>::quiet_NaN();
  pending_.begin(time, {passage.blow, {0.0, Side::kAfterBlow}}, passage.speed_before, rate, uncertainty);
  pending_.follow(tracker_->blowFactor());
  last_blow_ = end.stamp;
  turn_.begin(instant(time, step_->atSide(passage, Side::kAfterBlow)));
}

void TurnFollower::hullMovedAtBlow(const TipVelocity& hull) noexcept {
  pending_.setHullSpeed(hull.z + model_->mechanism().parameters().striking_distance * hull.rate);
}

/// Moves the part of the support's impulse with which an elastic rod accelerates the rocker from the blow to the
/// revolution.
void TurnFollower::addLaterMomentum(const CrankBlow& crank, LinkMomentum& after, RockerBlow& blow) const noexcept {
  const double u_after = blowInertia(model_->mechanism(), model_->level(), crank.drive_inertia).u_after;
  const double missing = blow.rocker_speed_after - u_after * blow.crank_speed_after;
  const double momentum = model_->mechanism().rockerFirstMoment() * missing;
  after = linkMomentum(*model_, {0.0, Side::kAfterBlow}, blow.crank_speed_after);
  after.z += momentum;
  blow.support_impulse_z -= momentum;
  blow.support_impulse_y -= model_->mechanism().parameters().rocker_inertia_about_pivot * missing;
}

/// Inflates errors of a blow too strong for the dead centre. If the tool was met early, the impulses are those of that
/// blow and their error is the difference to the dead centre. Otherwise it is that to the nearest possible blow.
void TurnFollower::inflateImpossible(CrankBlow crank, bool early, TurnEnd& end) const noexcept {
  RockerBlow other = end.blow;
  if (early) {
    crank.early = true;
    end.blow = measuredBlow(*model_, crank);
    end.blow_errors = blowErrors(*columns_, *model_, crank, pending_.columns(), end.blow);
    end.blow.impossible = true;
    end.blow.energy = std::numeric_limits<double>::quiet_NaN();
  } else {
    const double restitution = -other.rocker_speed_after / other.rocker_speed_before;
    const double nearest = (1.0 + std::clamp(restitution, 0.0, 1.0)) / (1.0 + restitution);
    other.support_impulse_z += (nearest - 1.0) * other.tool_impulse_z;
    other.tool_impulse_z *= nearest;
  }
  addDifference(end.blow, other, end.blow_errors);
}

/// Adds the effects of a yielding hull: less effective inertia of the rocker, and an acceleration of the crank.
void TurnFollower::addHullDeviation(const HullMotionCovariance& hull, CrankBlow& crank) const noexcept {
  const BlowInertia inertia = blowInertia(model_->mechanism(), model_->level(), crank.drive_inertia);
  const double per_acceleration = model_->mechanism().rockerFirstMoment() * inertia.u_before / inertia.before();
  const double kick = kBlind * per_acceleration * std::sqrt(hull(1, 1));
  crank.inertia_std = std::hypot(crank.inertia_std, prior_->reflectedInertia());
  crank.factor_std = std::hypot(crank.factor_std, kick / crank.speed);
}

/// Subtracts the tool impulse's work at the hull's velocity, since the tool rests on the rock, not on the hull.
void TurnFollower::countHullSpeed(TurnEnd& end) const noexcept {
  RockerBlow& blow = end.blow;
  if (pending_.hullSpeed()) {
    blow.energy -= blow.tool_impulse_z * *pending_.hullSpeed();
  } else if (prior_ != nullptr) {
    NumberError& error = end.blow_errors.energy;
    error.columns[kHullColumn] = blow.tool_impulse_z * prior_->speedAtBlow(turn_.swing());
    blow.energy_std = error.deviation();
  }
}

void TurnFollower::finishBlow(SampleResult& result) noexcept {
  if (!pending_.isWaiting()) return;
  if (pending_.isWithheld() && !(tracker_->strikeConsistency() <= CrankTrust::kMost)) return discard();
  if (tracker_->estimate().position.isMirrored()) {  // blank firing
    pending_.drop();
    restart();
    --turns_;
    ++blank_;
    return;
  }
  LinkMomentum after = linkMomentum(*model_, {0.0, Side::kAfterBlow}, pending_.crankSpeedAfter());
  RockerBlow& blow = pending_end_.blow;
  const CrankBlow measured = pending_.take();
  const std::optional<CrankBlow> elastic = elastic_->blow();  // an elastic rod shows more than the crank's speed
  CrankBlow crank = elastic.value_or(measured);
  if (!elastic) {
    const BlowInertia inertia = blowInertia(model_->mechanism(), model_->level(), crank.drive_inertia);
    crank.factor_std =
        std::hypot(crank.factor_std,
                   rod_->restitutionDeviation(inertia.restitution(crank.factor)) / inertia.restitutionPerFactor(),
                   crank.factor * rod_->lackingSpeed() / crank.speed);
  }
  if (prior_ != nullptr && !result.hull.moves) addHullDeviation(result.hull.covariance, crank);
  const double taken_up = model_->mechanism().rockerFirstMoment() * rod_->struck();
  const double uncertainty = std::hypot(measured.speed_std / measured.speed, measured.factor_std / measured.factor);
  const HullWrench read{std::abs(after.x) * uncertainty, std::abs(after.z) * uncertainty, 0.0};
  errors_.momentumAfterBlow({{read.force_x, std::hypot(read.force_z, taken_up), 0.0}, read},
                            momentumColumns(*columns_, *model_, {0.0, Side::kAfterBlow}, pending_.crankSpeedAfter(),
                                            pending_.columnsAfter()));
  blow = measuredBlow(*model_, crank);
  if (elastic) addLaterMomentum(crank, after, blow);
  turn_.correctBegin(after);
  BlowErrors& errors = pending_end_.blow_errors;
  errors = blowErrors(*columns_, *model_, crank, pending_.columns(), blow);
  if (!elastic) {
    CrankBlow rigid = measured;
    const double lacking = square(rod_->lackingSpeed());
    rigid.speed_std = std::sqrt(std::max(0.0, square(rigid.speed_std) - lacking));
    errors.setRodBeyond(ownErrors(*model_, rigid, measuredBlow(*model_, rigid)));
  }
  voidImpossible(model_->mechanism(), model_->level(), blow);
  if (blow.impossible) inflateImpossible(crank, !elastic && pending_.isEarly(), pending_end_);
  impossible_ += blow.impossible;
  countHullSpeed(pending_end_);
  pending_end_.mean_hold_down_force *= blow.tool_impulse_z;
  if (result.turn_ends < result.ends.size()) result.ends[result.turn_ends++] = pending_end_;
}

}  // namespace hammer_loads
