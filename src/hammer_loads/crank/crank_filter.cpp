// Crank filter: construction, restart, one sample from its conversion to its update, and the identification of the
// machine.
#include "hammer_loads/crank/crank_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/estimation/covariance_root.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/ablation.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;

constexpr double kKick = 0.35;           // part of the speed: no torque changes more between two samples
constexpr double kLeastInertia = 0.1;    // part of the first guess: nominal parameters are not further off
constexpr double kMostInertia = 1000.0;  // times the first guess: a crank held at constant speed appears that heavy
constexpr double kRelearn = 0.05;        // relative standard deviation of the inertia after an unexplained innovation
constexpr double kMostTorque = 3.0;      // times its initial standard deviation: more is due to a bad sample
// Prior: kRelearn, kMostTorque
constexpr double kSoundSpeeds = 2.0;  // times the largest plausible speed: beyond it the filter has diverged
// Limit: kSoundSpeeds
// Prior: kLeastInertia, kMostInertia
constexpr int kOneSided = 3;       // innovations of one sign beyond 5 standard deviations: not jitter
constexpr int kOneSidedLost = 10;  // such innovations after many restarts: readings are consistent again
constexpr double kGrossInnovationLength =
    50.0;  // samples over which innovations beyond 5 standard deviations are counted
constexpr double kManyGrossInnovations = 2.5;  // of these: more than jolts of the supply cause
constexpr double kSlip = 3e-3;                 // [s]: largest common error of successive stamps

constexpr double kUnlearnEvery = 3.0;  // [s]
constexpr double kUselessAngle = 0.3;  // [rad]: predicted standard deviation beyond which the prediction is useless
constexpr double kForgetContradictions = 30.0;  // [s]

}  // namespace

CrankFilter::CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings)
    : model_(model.tabulated()),
      step_model_(model_),
      settings_(settings),
      first_guess_(drive_inertia),
      encoder_(settings.angle_resolution, settings.sensor),
      timing_(settings.timing_noise),
      supply_(settings.initial_torque_std),
      errors_(settings.constant_deviations, settings.zero_std),
      blows_({settings.blow_factor, settings.blow_std}),
      speed_variance_(square(settings.speed_noise)) {
  now_.state.drive_inertia = drive_inertia;
  now_.least_inertia = kLeastInertia * drive_inertia;
  now_.most_inertia = kMostInertia * drive_inertia;
  now_.factor = settings.blow_factor;
  now_.covariance(Belief::kInertia, Belief::kInertia) = square(settings.initial_inertia_std);
}

void CrankFilter::countGrossInnovation(bool is_gross) noexcept {
  gross_innovations_ += (is_gross ? 1.0 : 0.0) - gross_innovations_ / kGrossInnovationLength;
}

double CrankFilter::mostSpeed() const noexcept { return kSoundSpeeds * settings_.max_speed; }
double CrankFilter::mostTorque() const noexcept { return kMostTorque * settings_.initial_torque_std; }

void CrankFilter::start(const CrankSample& reading, double jitter) noexcept {
  if (jitter > timing_.deviation())
    timing_.restart(jitter);  // keeps the last speed, as no other is known
  else
    now_.state.speed = 0.0;
  const WeighedSample sample = weighed(reading);
  now_.state.position = {0, CrankAngle::fromOffset(sample.angle)};
  now_.state.torque = 0.0;
  anchor(sample);
}

/// Restarts angle and speed by the sample alone; the torque's variance is reset, the identified inertia is kept. The
/// number of revolutions is the one nearest to now_.
void CrankFilter::anchor(const WeighedSample& sample) noexcept {
  ShaftState& s = now_.state;
  const double inertia_variance = now_.covariance(Belief::kInertia, Belief::kInertia);
  s.position.turn(CrankAngle::wrapToPi(sample.angle - s.position.angle.offset));
  s.speed = sample.speed.value_or(s.speed);
  s.torque = std::clamp(s.torque, -mostTorque(), mostTorque());
  has_speed_ = sample.speed.has_value();
  read_side_.reset();
  speed_trust_.restart();
  angle_lag_.begin(s.speed);
  supply_.restart();
  outlier_ = 0.0;
  unexplained_ = 0;
  updateLoad();
  now_.tool_met = false;
  mirrored_ = false;
  hypothesis_.drop();
  strike_consistency_.abandon();
  now_.factor = settings_.blow_factor;
  ShaftMatrix& p = now_.covariance;
  p.setZero();
  p(Belief::kAngle, Belief::kAngle) = sample.angleVariance(s.speed);
  p(Belief::kSpeed, Belief::kSpeed) = has_speed_ ? speed_variance_ : square(settings_.max_speed);
  p(Belief::kTorque, Belief::kTorque) = square(settings_.initial_torque_std);
  // NaN-proof by min: never above the first guess
  p(Belief::kInertia, Belief::kInertia) = std::min(square(settings_.initial_inertia_std), inertia_variance);
  p(Belief::kFactor, Belief::kFactor) = square(settings_.blow_std);
  now_.by_constant.setZero();
  now_.by_constant.row(Belief::kAngle) = ConstantErrors::ofAngle({s.position.angle.offset, s.speed, 0.0});
  if (has_speed_)
    now_.by_constant.row(Belief::kSpeed) = ConstantErrors::ofSpeed({s.position.angle.offset, s.speed, 0.0});
}

/// Steps (1) to (10) are those of model.md 6.
Tracking CrankFilter::update(double dt, const CrankSample& reading) noexcept {
  CrankBelief& last = earlier_[1 - before_];
  last = now_;
  lost_time_ = instant_off_ = 0.0;
  counts_intervals_ = false;
  restart_load_ *= std::max(0.0, 1.0 - dt / look_back::kTenTurns);
  contradictions_ *= std::max(0.0, 1.0 - dt / kForgetContradictions);
  step_model_.setHullMotion(blend(now_hull_, model_.hullMotion(), 0.5));
  const bool struck = predict(dt, true, now_) > 0;  // (1)
  const bool moved = applyZero();
  SampleStep to{last, weighed(reading), dt, struck};  // (2)
  to.read = to.sample.angle;
  const bool begins = findLag() || moved;
  to.behind = subtractLag(last, dt, struck, to.read, to.sample);
  if (begins) return begin(to.sample);
  to.innovation = to.sample.ofAngle(now_);
  instant_off_ = std::abs(now_.state.speed) > kLearnSpeed ? to.innovation.value / now_.state.speed : 0.0;
  if (has_speed_)
    if (const auto result = followSensor(to)) return *result;
  comparison_.reset();
  if (to.sample.speed) comparison_.emplace().measured = *to.sample.speed;
  if (has_speed_)
    if (const auto result = judge(to)) return *result;
  return accept(to, reading.angle);
}

/// Handles lost samples and slips of the encoder. The update ends here for a slip that the next sample must confirm,
/// and for an invalid prediction.
std::optional<Tracking> CrankFilter::followSensor(SampleStep& to) noexcept {
  followLostTime(to);
  const double way = now_.encoderSpeed() * clock_.interval;
  counts_intervals_ =
      exceeds(way, to.innovation.total, 2.0 * gate::kImpossible) && !to.innovation.exceeds(gate::kImpossible);
  const EncoderSlip::Step step = followSlip(to.dt, to.innovation, to.sample);
  if (step == EncoderSlip::Step::kPerhaps) {  // ignored as an outlier until the next sample decides
    countGrossInnovation(true);
    return ignore(to.last, to.innovation);
  }
  if (step == EncoderSlip::Step::kSlipped) to.innovation = to.sample.ofAngle(now_);
  const double deviation = std::sqrt(now_.covariance(Belief::kAngle, Belief::kAngle));
  if (deviation < kUselessAngle) return std::nullopt;
  if (!now_.isSound(mostSpeed())) now_ = to.last;
  // Discards a speed so uncertain that the next sample would restart as well.
  if (!(std::sqrt(speed_variance_) * to.dt < kUselessAngle)) to.sample.speed.reset();
  return begin(to.sample);
}

/// Gates the sample; if it contradicts the prediction, decides whether another contact, an unusual blow or an outlier
/// is the cause, which ends the update.
std::optional<Tracking> CrankFilter::judge(SampleStep& to) noexcept {
  WeighedSample& sample = to.sample;
  Innovation& innovation = to.innovation;
  const double ratio = innovation.ratio();
  if (!usesSpeeds()) sample.speed.reset();
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

/// reading: raw reading of the encoder [rad].
Tracking CrankFilter::accept(const SampleStep& to, double reading) noexcept {
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
  checkInertia(to.dt);
  updateLoad();
  judgeSpeed(to.dt, to.struck);
  if (!std::exchange(has_speed_, true)) return Tracking::kRestarted;
  return revised ? Tracking::kRevised : Tracking::kContinued;
}

/// (1)
int CrankFilter::predict(double dt, bool contact, CrankBelief& belief) const noexcept {
  const CrankAngle at = belief.state.position.angle;
  const bool known = at == load_angle_ && step_model_.hullMotion() == now_hull_;
  return belief.predict(step_model_, known ? load_ : step_model_(at), walks(), blows_.prior(), contact, mostSpeed(),
                        dt);
}

/// (6)
void CrankFilter::correctAngle(Innovation innovation) noexcept {
  const double squared = square(innovation.value);
  const int side =
      !HAMMER_LOADS_ABLATE(surprises) && innovation.exceeds(gate::kImpossible) ? (innovation.value > 0.0 ? 1 : -1) : 0;
  if (side != 0) unexplained_ = side * unexplained_ < 0 ? side : unexplained_ + side;
  countGrossInnovation(side != 0);
  const bool one_sided = std::abs(unexplained_) >= (isLost() ? kOneSidedLost : kOneSided);
  if (side != 0 && !one_sided && (gross_innovations_ > kManyGrossInnovations || isLost())) {
    innovation.variance = squared / square(gate::kImpossible);  // many on both sides: jittering stamps
  } else if (side != 0) {
    const double factor = (squared / square(gate::kUsual) - innovation.variance) / now_.encoderVariance(Belief::kAngle);
    now_.widen(factor);
    now_.forgetInertiaCoupling();
    // The inertia may be the cause of the misfit: its variance is raised, so that it is learned again.
    double& inertia = now_.covariance(Belief::kInertia, Belief::kInertia);
    if (!HAMMER_LOADS_ABLATE(relearn)) inertia = std::max(inertia, square(kRelearn));
  }
  if (gross_innovations_ > kManyGrossInnovations) now_.forgetInertiaCoupling();  // they would bias the inertia
  now_.correct(Belief::kAngle, innovation.value, innovation.variance, innovation.by_error);
}

/// (5) Returns true if following the reading would change speed and torque too much: 0.3 rad at 1 kHz gave a thousand
/// times the peak force. A crank at constant speed, which the model takes for a heavy one, remains below a kick of 0.35
/// from 100 Hz on; a slow one may stop at once.
bool CrankFilter::isContradiction(double dt, const Innovation& innovation) const noexcept {
  const double most = std::max(kKick * std::abs(now_.state.speed), kLearnSpeed) * dt;
  return std::abs(innovation.value) > EncoderSlip::kMost ||
         (std::abs(innovation.value) > most && innovation.exceeds(gate::kImpossible));
}

/// Restarts at this sample. A speed that was kept from before a restart and is contradicted again is wrong itself.
Tracking CrankFilter::begin(const WeighedSample& sample) noexcept {
  restart_load_ += 1.0;
  speeds_wait_ = speeds_wait_ || (has_speed_ && sample.isUnsureOfTime(now_.state.speed));
  if (!has_speed_ && !sample.speed) now_.state.speed = now_.state.torque = 0.0;
  anchor(sample);
  if (now_.state.speed > kLearnSpeed) hypothesis_.beginAnew(now_);
  return Tracking::kRestarted;
}

/// Ignores the sample, but notes it for confirmation by the next one and as evidence of a rod.
Tracking CrankFilter::ignore(const CrankBelief& last, const Innovation& innovation) noexcept {
  rod_evidence_.add(now_.state.position.angle, innovation.ratio());
  now_ = last;
  outlier_ = innovation.value;
  return Tracking::kOutlier;
}

/// (5) Handles a contradiction: one such sample is ignored, a second one restarts. Empty if the sample is used as any
/// other, with the angle unknown.
std::optional<Tracking> CrankFilter::contradict(const CrankBelief& last, double dt, const Innovation& innovation,
                                                const WeighedSample& sample) noexcept {
  const double most = kKick * std::abs(now_.state.speed) * dt + kKick * std::abs(outlier_);
  countGrossInnovation(true);
  const bool agrees = std::abs(CrankAngle::wrapToPi(innovation.value - outlier_)) < most;
  const bool confirmed = outlier_ != 0.0 && (agrees || gross_innovations_ < kManyGrossInnovations);
  if (!confirmed) return ignore(last, innovation);
  // Contradicted on the mirrored branch: there was contact.
  if (!agrees || mirrored_ || std::abs(innovation.value) > kSlip * std::abs(now_.state.speed)) {
    WeighedSample angle_alone = sample;
    angle_alone.speed.reset();
    return begin(angle_alone);
  }
  now_.forgetAngle(square(innovation.value));  // a sample was lost: the time is wrong, not the motion
  return std::nullopt;
}

/// (6) to (9). last: the belief at the sample before; struck: the prediction passed a blow.
bool CrankFilter::correct(const CrankBelief& last, double dt, bool struck, const Innovation& innovation,
                          const WeighedSample& sample, double reading) noexcept {
  if (struck) beginHypothesis(last);
  const bool contested = hypothesis_.isThere();
  if (std::abs(now_.state.speed) < kLearnSpeed) now_.forgetInertiaCoupling();
  correctAngle(innovation);
  settleSide(last, dt, sample, struck);
  read_side_ = readSide(reading);
  applyReadSide(last, dt, struck, sample, reading);
  if (comparison_) {
    const ConstantErrors::Row by_error = now_.encoderByError(Belief::kSpeed);
    comparison_->speed = now_.encoderSpeed();
    comparison_->variance = now_.encoderVariance(Belief::kSpeed) + square(settings_.speed_noise);
    comparison_->by_lag = by_error[ConstantErrors::kSpeedLag];
    comparison_->by_scale = by_error[ConstantErrors::kSpeedScale];
  }
  if (sample.speed) correctSpeed(sample, dt, struck);
  if (!mirrored_ && now_.state.position.isMirrored()) now_.stopAtBlow();  // moved there by the speed's correction
  now_.boundFactor();
  if (contested && hypothesis_.isThere()) {
    predict(dt, mirrored_, hypothesis_.belief());
    hypothesis_.follow(sample, model_, fit_, consistency_.growth(), mostSpeed());
  }
  checkContact();
  return hypothesis_.isThere() && hypothesis_.choose(now_, mirrored_);
}

Eigen::Matrix3d CrankUncertainty::covariance() const noexcept { return own + covarianceOf(by_constant.topRows<3>()); }

void CrankFilter::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  hull_moved_ = true;
}

/// Computes the load at now_, with the latest motion of the hull.
void CrankFilter::updateLoad() noexcept {
  load_angle_ = now_.state.position.angle;
  load_ = model_(load_angle_);
  now_hull_ = model_.hullMotion();
  hull_moved_ = false;
}

/// Inflates the speed's variance where a rod's vibration would bias the filter, which has no rod; smaller vibrations
/// are smoothed. A reading that is then followed is the same evidence of a rod as one that contradicts the prediction.
void CrankFilter::inflateByRod(double angle, double speed) noexcept {
  rod_.followed = true;
  double& of_speed = now_.covariance(Belief::kSpeed, Belief::kSpeed);
  if (HAMMER_LOADS_ABLATE(rod_considered) || !exceeds(speed, of_speed, gate::kImpossible)) return;
  rod_evidence_.add(now_.state.position.angle, square(speed) / of_speed);
  of_speed += square(speed);
  now_.covariance(Belief::kAngle, Belief::kAngle) += square(angle);
  rod_.angle = angle, rod_.speed = speed;
}

/// Returns the innovation for a rigid mechanism, without the variance added for an elastic rod.
Innovation CrankFilter::withoutRod(double dt, Innovation innovation) const noexcept {
  innovation.total = std::max(innovation.variance, innovation.total - square(rod_.angle) - square(dt * rod_.speed));
  return innovation;
}

BlowFactor CrankFilter::blowFactor() const noexcept {
  return now_.blowFactor(consistency_.publishedGrowth(), errors_.root());
}

bool CrankFilter::isPlausible() const noexcept { return std::abs(now_.state.torque) <= mostTorque(); }

CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  if (dt == 0.0) return estimateOf(before_load_, before().state);
  return estimateBetween(lastStep(), dt);
}

std::optional<CrankPaths> CrankFilter::pathsBetween(double dt) const noexcept {
  return hammer_loads::pathsBetween(lastStep(), std::min(dt, step_));
}

/// The forward prediction may reach the blow earlier than the path between both samples, with a factor not known yet.
CrankUncertainty CrankFilter::uncertaintyBetween(double dt, double torque_part) const noexcept {
  if (dt >= step_) return uncertainty(torque_part);
  CrankBelief belief = before();
  const bool comes_to_blow =
      before().state.position.angle.side == Side::kBeforeBlow && isNearTool(before().state, step_);
  const bool is_before = comes_to_blow && between(dt).position.angle.side == Side::kBeforeBlow;
  predict(dt, !is_before, belief);
  return uncertaintyOf(belief, model_(belief.state.position.angle), torque_part);
}

CrankUncertainty CrankFilter::uncertaintyOf(const CrankBelief& belief, const ShaftLoad& load,
                                            double torque_part) const noexcept {
  const double part = std::min(1.0, torque_part * roughness_.deviationFactor());
  return motionUncertainty(model_, load, belief, consistency_.publishedGrowth(), errors_.root(), part);
}

/// (10) Learns once a revolution, half a revolution after the blow, when all samples that determine it are known.
void CrankFilter::rememberBlow(const CrankBelief& last, double dt) noexcept {
  supply_.pass(dt);
  const CrankPosition &from = last.state.position, &to = now_.state.position;
  if (from.angle.side != Side::kAfterBlow || to.angle.side != Side::kBeforeBlow || to.blow != from.blow + 1) return;
  const bool had_contact = !from.isMirrored() && !to.isMirrored();
  supply_.endTurn(to, had_contact);
  speed_trust_.endTurn();
  slip_.endTurn();
  if (!had_contact) return;
  updateConsidered();
  errors_.endTurn(consistency_.growth(), encoder_.resolution());
  if (!HAMMER_LOADS_ABLATE(supply_law)) learnSupply();
  if (!HAMMER_LOADS_ABLATE(blow_history))
    blows_.add(now_.factor, now_.covariance(Belief::kFactor, Belief::kFactor), now_.by_constant.row(Belief::kFactor));
}

/// (10) Corrects the supply's stiffness by its estimated error; the sensor's errors are not corrected.
void CrankFilter::learnSupply() noexcept {
  const double change = supply_.learn(errors_.estimate()[ConstantErrors::kSupply]);
  now_.move(now_.by_constant.col(ConstantErrors::kSupply).cast<double>() * change);
  errors_.shiftSupply(change);
}

/// (10) ratio: square of the innovation over its variance, before a contact with the tool was included.
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
void CrankFilter::checkInertia(double dt) noexcept {
  unlearn_after_ -= dt;
  if (HAMMER_LOADS_ABLATE(contradicted_inertia) || !(consistency_.growth() > mismatch::kUnexplained) ||
      unlearn_after_ > 0.0)
    return;
  unlearn_after_ = kUnlearnEvery;
  contradictions_ += 1.0;
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
