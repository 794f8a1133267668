// Update by a sample: prediction, sensor, gate, identification of the machine by sample and by turn, and its reset.
#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/ablation.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;

constexpr double kUnlearnEvery = 3.0;   // [s]
constexpr double kDoubtfulAngle = 0.3;  // [rad] predicted deviation from which on the prediction is worth nothing
constexpr double kForgetDoubts = 30.0;  // [s]

}  // namespace

/// Steps (1) to (10) are those of model.md 6.
Tracking CrankFilter::update(double dt, const CrankSample& reading) noexcept {
  CrankBelief& last = earlier_[1 - before_];
  last = now_;
  lost_time_ = instant_off_ = 0.0;
  counts_intervals_ = false;
  restart_load_ *= std::max(0.0, 1.0 - dt / look_back::kTenTurns);
  doubt_load_ *= std::max(0.0, 1.0 - dt / kForgetDoubts);
  step_model_.setHullMotion(blend(now_hull_, model_.hullMotion(), 0.5));
  const bool struck = predict(dt, true, now_) > 0;  // (1)
  const bool moved = applyZero();
  SampleStep to{last, weighed(reading), dt, struck};  // (2)
  to.read = to.sample.angle;
  const bool begins = findLag() || moved;
  to.behind = takeOffLag(last, dt, struck, to.read, to.sample);
  if (begins) return begin(to.sample);
  to.innovation = to.sample.ofAngle(now_);
  instant_off_ = std::abs(now_.state.speed) > kLearnSpeed ? to.innovation.value / now_.state.speed : 0.0;
  if (has_speed_)
    if (const auto result = followSensor(to)) return *result;
  witness_.reset();
  if (to.sample.speed) witness_.emplace().measured = *to.sample.speed;
  if (has_speed_)
    if (const auto result = judge(to)) return *result;
  return take(to, reading.angle);
}

/// Handles lost samples and slips of the encoder. The update ends here for a slip that the next sample must confirm,
/// and for an invalid prediction.
std::optional<Tracking> CrankFilter::followSensor(SampleStep& to) noexcept {
  followLostTime(to);
  const double way = now_.encoderSpeed() * clock_.interval;
  counts_intervals_ =
      exceeds(way, to.innovation.total, 2.0 * gate::kImpossible) && !to.innovation.exceeds(gate::kImpossible);
  const EncoderSlip::Step step = followSlip(to.dt, to.innovation, to.sample);
  if (step == EncoderSlip::Step::kPerhaps) {  // else an outlier as any other
    countSurprise(true);
    return ignore(to.last, to.innovation);
  }
  if (step == EncoderSlip::Step::kSlipped) to.innovation = to.sample.ofAngle(now_);
  const double deviation = std::sqrt(now_.covariance(Belief::kAngle, Belief::kAngle));
  if (deviation < kDoubtfulAngle) return std::nullopt;
  if (!now_.isSound(mostSpeed())) now_ = to.last;
  // The next would restart too.
  if (!(std::sqrt(speed_variance_) * to.dt < kDoubtfulAngle)) to.sample.speed.reset();
  return begin(to.sample);
}

/// Gates the sample; if it contradicts the prediction, decides whether another contact, an unusual blow or an outlier
/// is the cause, which ends the update.
std::optional<Tracking> CrankFilter::judge(SampleStep& to) noexcept {
  WeighedSample& sample = to.sample;
  Innovation& innovation = to.innovation;
  const double ratio = innovation.ratio();
  if (!takesSpeeds()) sample.speed.reset();
  fit_ = innovation.logLikelihood();
  if (!HAMMER_LOADS_ABLATE(jitter)) timing_.learn(innovation.value, innovation.total, now_.state.speed, to.dt);  // (3)
  sample.timing_variance = timing_.variance();
  const bool without_contact = ratio > square(kToolSeen) && hypothesisExplains(to.dt, sample);
  if (without_contact) return std::nullopt;
  if (meetsTool(to.dt, innovation, sample) || meetsOtherBlow(to.dt, innovation, sample))
    innovation = sample.ofAngle(now_);                    // (4)
  if (isContradiction(to.dt, innovation) && !isLost()) {  // (5)
    if (const auto result = contradict(to.last, to.dt, innovation, sample)) {
      if (*result == Tracking::kOutlier) lost_time_ = 0.0;
      return *result;
    }
    innovation = sample.ofAngle(now_);
  }
  learnFrom(innovation, ratio);  // (10)
  return std::nullopt;
}

/// reading: of the encoder, as it came [rad].
Tracking CrankFilter::take(const SampleStep& to, double reading) noexcept {
  sample_ = to.sample;
  angle_fit_ = withoutRod(to.dt, to.innovation).logLikelihood();
  before_ = 1 - before_;
  before_load_ = load_;
  before_hull_ = now_hull_;
  step_ = to.dt;
  usual_step_.add(to.dt);
  angle_lag_.go(to.behind);
  outlier_ = 0.0;
  const bool revised = correct(to.last, to.dt, to.struck, to.innovation, to.sample, reading);
  rod_ = {};
  if (!now_.isSound(mostSpeed())) {
    now_ = to.last;
    return begin(to.sample);
  }
  rememberBlow(to.last, to.dt);
  doubtInertia(to.dt);
  takeLoad();
  judgeSpeed(to.dt, to.struck);
  if (!std::exchange(has_speed_, true)) return Tracking::kRestarted;
  return revised ? Tracking::kRevised : Tracking::kContinued;
}

/// (10) Learns once a turn, half a turn after the blow, when all samples that determine it are known.
void CrankFilter::rememberBlow(const CrankBelief& last, double dt) noexcept {
  supply_.pass(dt);
  const CrankPosition &from = last.state.position, &to = now_.state.position;
  if (from.angle.side != Side::kAfterBlow || to.angle.side != Side::kBeforeBlow || to.blow != from.blow + 1) return;
  const bool had_contact = !from.isMirrored() && !to.isMirrored();
  supply_.endTurn(to, had_contact);
  speed_trust_.endTurn();
  slip_.endTurn();
  if (!had_contact) return;
  considerSensor();
  errors_.endTurn(consistency_.growth(), encoder_.resolution());
  if (!HAMMER_LOADS_ABLATE(supply_law)) learnSupply();
  if (!HAMMER_LOADS_ABLATE(blow_history))
    blows_.add(now_.factor, now_.covariance(Belief::kFactor, Belief::kFactor), now_.by_constant.row(Belief::kFactor));
}

/// (10) Other than the sensor's errors, that of the supply's stiffness is corrected.
void CrankFilter::learnSupply() noexcept {
  const double change = supply_.learn(errors_.estimate()[ConstantErrors::kSupply]);
  now_.move(now_.by_constant.col(ConstantErrors::kSupply) * change);
  errors_.takeSupply(change);
}

/// (10) ratio: of the innovation before a tool or a slip was used.
void CrankFilter::learnFrom(const Innovation& innovation, double ratio) noexcept {
  if (std::abs(now_.state.speed) <= kLearnSpeed) return;
  consistency_.add(ratio);
  rod_evidence_.add(now_.state.position.angle, ratio);
  if (now_.state.position.angle.side == Side::kBeforeBlow)
    strike_consistency_.add(ratio);
  else
    strike_consistency_.endHalfTurn();
  const double jitter = square(now_.state.speed) * timing_.variance();
  if (!HAMMER_LOADS_ABLATE(supply_roughness))
    roughness_.learn(innovation.value, innovation.total, jitter / innovation.total);
  if (!HAMMER_LOADS_ABLATE(sensor_errors))
    errors_.learn(innovation.value, innovation.total, innovation.by_error - now_.encoderByError(Belief::kAngle));
}

/// (10) Resets the identified machine if it has contradicted the readings for seconds, as it may have been identified
/// before the stamps' jitter was known.
void CrankFilter::doubtInertia(double dt) noexcept {
  unlearn_after_ -= dt;
  if (HAMMER_LOADS_ABLATE(doubt_inertia) || !(consistency_.growth() > mismatch::kUnexplained) || unlearn_after_ > 0.0)
    return;
  unlearn_after_ = kUnlearnEvery;
  doubt_load_ += 1.0;
  forgetInertia();
}

/// (10) Discards what was identified from other readings.
void CrankFilter::forgetInertia() noexcept {
  now_.state.drive_inertia = first_guess_;
  now_.by_constant.row(Belief::kInertia).setZero();
  now_.forgetInertiaCoupling();
  now_.covariance(Belief::kInertia, Belief::kInertia) = square(settings_.initial_inertia_std);
  now_.covariance(Belief::kTorque, Belief::kTorque) += square(settings_.initial_torque_std);
  consistency_.restart();
}

}  // namespace hammer_loads
