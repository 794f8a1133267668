// Filter at the blow and with an erroneous sensor: early contact with the tool, side of a sample, strokes without
// contact; lost samples, slips, speeds.
#include <algorithm>
#include <cmath>
#include <utility>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/util/ablation.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;

constexpr double kNearCounts = 4.0;       // counts from the blow within which the encoder decides its side
constexpr double kCertain = gate::kRare;  // standard deviations of the stamp within which an edge decides nothing
constexpr double kToolDeviation = 0.5;    // part of the crank's speed that an early contact may take
constexpr double kHiddenBranch = 0.25;    // probability: the other branch is then two standard deviations away
constexpr double kRingOver = 0.8;         // [rad] after the blow: a rod's vibration no longer looks like a torque
constexpr double kToolSeenByStamps = gate::kImpossible;  // gate for contact with jittering stamps
// Prior: kToolDeviation, kHiddenBranch

constexpr double kSpeedNoiseGain = 1.0 / look_back::kReadings;
constexpr double kLeastSpeedNoise = 0.3;  // part of the first guess
constexpr double kNotSlip = 0.04;         // [rad] from the blow: there the tool stops and throws the crank
constexpr double kBeganOfLate = 0.5;      // recent restarts: some 1.4 s after a single one
constexpr double kStrikeBegins = 0.6;     // [rad] before the blow: an elastic rod does not vibrate until there
constexpr double kRodMoves = 0.017;       // [rad]: largest effect of worn pins and an identified rod on readings there

}  // namespace

bool CrankFilter::isAtTool(double dt) const noexcept {
  return isNearTool(now_.state, dt) && now_.state.speed > kCreeping && !mirrored_;
}

/// (4) Detects early contact with the tool by a crank that is suddenly slower near the dead centre. Returns true if the
/// belief has included it.
bool CrankFilter::meetsTool(double dt, const Innovation& angle, const WeighedSample& sample) noexcept {
  const bool before = now_.state.position.angle.side == Side::kBeforeBlow;
  if (HAMMER_LOADS_ABLATE(tool_met) || !before || !(angle.value < 0.0) || !isAtTool(dt)) return false;
  const bool jitters = sample.timing_variance > 0.0;
  bool seen = angle.exceeds(jitters ? kToolSeenByStamps : kToolSeen);
  if (sample.speed) {
    const Innovation speed = sample.ofSpeed(now_, model_);
    const bool slower = speed.value < 0.0;  // an error of the stamp does not change it
    seen = (slower && speed.exceeds(kToolSeen)) || (seen && (!jitters || (slower && speed.exceeds(gate::kUsual))));
  }
  if (!seen) return false;
  now_.meetTool(kToolDeviation, dt);
  now_.tool_met = now_.struck_early = true;
  return true;
}

/// (4) Detects an unusual blow by a crank that is slower or faster than expected just after it.
bool CrankFilter::meetsOtherBlow(double dt, const Innovation& angle, const WeighedSample& sample) noexcept {
  const bool after = now_.state.position.angle.side == Side::kAfterBlow && sample.angle > 0.0;
  if (HAMMER_LOADS_ABLATE(other_blow) || !after || !isAtTool(dt)) return false;
  const double least = sample.timing_variance > 0.0 ? kToolSeenByStamps : kToolSeen;
  bool by_angle = angle.exceeds(least) && !isContradiction(dt, angle);
  if (sample.speed) {
    const Innovation speed = sample.ofSpeed(now_, model_);
    const double ratio = speed.value * angle.value > 0.0 ? speed.ratio() : 0.0;
    if (ratio > square(kToolSeen)) return now_.inflateBlow(Belief::kSpeed, speed.value, speed.total, dt);
    by_angle = by_angle && ratio > 1.0;  // the prior may explain the speed; equal signs show the blow
  }
  return by_angle && now_.inflateBlow(Belief::kAngle, angle.value, angle.total, dt);
}

/// (7) Undoes a predicted blow that has not occurred within this step.
void CrankFilter::undoBlow(const CrankBelief& last, double dt, const WeighedSample& sample) noexcept {
  hypothesis_.drop();
  now_ = last;
  predict(dt, false, now_);
  Innovation again = sample.ofAngle(now_);
  const bool may_be_tool = again.value > -std::abs(last.state.speed) * dt;  // which stops the crank at most
  if (may_be_tool && meetsTool(dt, again, sample)) again = sample.ofAngle(now_);
  now_.correct(Belief::kAngle, again.value, again.variance, again.by_error);
  if (now_.state.position.isMirrored()) now_.stopAtBlow();
}

/// (7) The corrected angle may lie on the other side of the blow than the prediction. Forward: it passes the blow late.
/// Back over a blow that was predicted within this very step: there was none yet.
void CrankFilter::settleSide(const CrankBelief& last, double dt, const WeighedSample& sample, bool struck) noexcept {
  CrankAngle& angle = now_.state.position.angle;
  if (mirrored_) {
    mirrored_ = now_.state.position.isMirrored();
    return;
  }
  if (!now_.state.position.isMirrored()) return;
  if (angle.side == Side::kBeforeBlow) {
    if (now_.state.speed > 0.0) {
      beginHypothesis(now_);
      return now_.passLate(step_model_, blows_.prior());
    }
    angle.side = Side::kAfterBlow;
    return;
  }
  if (struck) return undoBlow(last, dt, sample);
  const double margin =
      kNearCounts * encoder_.resolution() + kCertain * std::sqrt(sample.angleVariance(now_.state.speed));
  if (angle.offset > -margin && now_.state.speed > -1.0) {
    now_.stopAtBlow();  // it stands or moves on, within the errors of count and stamp
  } else {
    angle.side = Side::kBeforeBlow;
  }
}

/// Side of the blow by the count, which is certain if an edge of the count is at the blow and the stamp is exact.
std::optional<Side> CrankFilter::readSide(double reading) const noexcept {
  if (HAMMER_LOADS_ABLATE(encoder_edge) || encoder_.isFiner() || settings_.angle_noise > 0.0 || angle_lag_.isThere())
    return std::nullopt;
  constexpr double kEdge = 1e-6;  // part of a count
  // Numerical: kEdge
  const double count = encoder_.resolution(), edge_tolerance = kEdge * count;
  const double margin = kCertain * std::abs(now_.state.speed) * timing_.deviation();
  const auto [low, high] = encoder_.edges(reading);
  if (low - margin > -edge_tolerance) return Side::kAfterBlow;
  if (high + margin < edge_tolerance) return Side::kBeforeBlow;
  return std::nullopt;
}

/// (7) Keeps the estimate from passing the blow before the encoder does, since the wrench jumps at the blow.
void CrankFilter::applyReadSide(const CrankBelief& last, double dt, bool struck, const WeighedSample& sample,
                                double reading) noexcept {
  CrankAngle& angle = now_.state.position.angle;
  const double near = kNearCounts * encoder_.resolution();
  if (!read_side_ || mirrored_ || std::abs(angle.offset) > near) return;
  if (std::abs(encoder_.edges(reading).low) > near) return;
  if (*read_side_ == Side::kAfterBlow && angle.side == Side::kBeforeBlow) {
    beginHypothesis(now_);
    angle.offset = 0.0;
    now_.passLate(step_model_, blows_.prior());
  }
  if (*read_side_ == Side::kAfterBlow || angle.side == Side::kBeforeBlow) return;
  if (struck) return undoBlow(last, dt, sample);
  angle = {0.0, Side::kBeforeBlow};
  now_.tool_met = true;  // its factor is in the speed already
}

/// Begins the second hypothesis, without contact, before the belief passes the blow with contact. A crank that rests
/// there does not pass it.
void CrankFilter::beginHypothesis(const CrankBelief& belief) noexcept {
  if (!HAMMER_LOADS_ABLATE(contact_hypothesis) && !mirrored_ && !belief.tool_met && belief.state.speed > kLearnSpeed)
    hypothesis_.begin(belief);
}

/// (9) Returns the probability of the other branch. A rod's vibration may resemble the torque that shows blank firing;
/// both branches then remain possible until the next dead centre.
double CrankFilter::otherBranch() const noexcept {
  return std::max(hypothesis_.probability(), mirrored_ && rod_hides_branch_ ? kHiddenBranch : 0.0);
}

/// (9) Returns true if the second hypothesis explains the sample.
bool CrankFilter::hypothesisExplains(double dt, const WeighedSample& sample) noexcept {
  if (!hypothesis_.isOpen()) return false;
  CrankBelief other = hypothesis_.belief();
  predict(dt, mirrored_, other);
  return !sample.ofAngle(other).exceeds(gate::kRare);
}

/// (9) Examines the other branch from 0.8 rad after a blow on. On a wrong branch no sample need contradict the
/// estimate, because the estimated torque compensates the blow. If the supply never has such a torque, the other branch
/// is tried with a usual one.
void CrankFilter::checkContact() noexcept {
  if (HAMMER_LOADS_ABLATE(contact_by_torque) || !(now_.state.position.angle.offset > kRingOver)) return;
  supply_.addTorque(now_.state.torque);
  if (hypothesis_.isThere()) return;
  const double margin = consistency_.publishedGrowth();
  const double variance = supply_.usual() + margin * now_.covariance(Belief::kTorque, Belief::kTorque);
  if (margin > mismatch::kContradicts || !exceeds(now_.state.torque, variance, gate::kImpossible)) return;
  CrankBelief other = now_;
  other.state.torque = 0.0;
  other.draw(Belief::kTorque, supply_.usual());
  rod_hides_branch_ = rod_.followed;
  hypothesis_.beginWithEvenOdds(other);
}

/// (2) Converts the readings of the sensor to angle and speed of the crank, with their noise.
WeighedSample CrankFilter::weighed(const CrankSample& reading) noexcept {
  const double angle = encoder_.angle(reading.angle);
  WeighedSample sample{CrankAngle::fromAngle(angle).offset, reading.speed};
  if (sample.speed) sample.speed = encoder_.speed(angle, *reading.speed);
  sample.angle_variance = encoder_.variance() + square(settings_.angle_noise);
  sample.timing_variance = timing_.variance();
  sample.speed_variance = speed_variance_;
  if (!sample.speed || speed_trust_.areGood()) return sample;
  sample.of_speed = ConstantErrors::Row::Zero();
  for (const int constant : {ConstantErrors::kSpeedLag, ConstantErrors::kSpeedScale})
    (*sample.of_speed)[constant] = static_cast<float>(square(errors_.consideredDeviation(constant)));
  return sample;
}

/// (10) Updates the standard deviations of latency, speed lag and speed scale, as given and as identified.
void CrankFilter::updateConsidered() noexcept {
  const double ahead =
      std::hypot(angle_lag_.deviation(), speed_trust_.lags() ? std::min(0.0, speed_trust_.lag()) : 0.0);
  errors_.setConsidered(ConstantErrors::kLatency, std::hypot(settings_.constant_deviations[ConstantErrors::kLatency],
                                                             std::hypot(stamps_off_, ahead)));
  if (!speed_trust_.isKnown()) return;
  const auto consider = [&](int constant, double amount, double deviation) {
    const double prior = settings_.constant_deviations[constant];
    if (!(prior > 0.0)) return;
    const double shown = std::max(0.0, square(amount) - square(gate::kUsual * deviation));
    errors_.setConsidered(constant, std::sqrt(square(std::min(prior, deviation)) + shown));
  };
  consider(ConstantErrors::kSpeedLag, speed_trust_.lag(), speed_trust_.lagDeviation());
  consider(ConstantErrors::kSpeedScale, speed_trust_.scale(), speed_trust_.scaleDeviation());
}

/// (2) Subtracts a lag of the angles behind the speeds from the readings from now on, and discards earlier results on
/// the sensor and its speeds.
bool CrankFilter::findLag() noexcept {
  const double more = -speed_trust_.lag();
  if (HAMMER_LOADS_ABLATE(angle_lag) || !speed_trust_.lags() || !(angle_lag_.isThere() || more > 0.0)) return false;
  angle_lag_.correct(more, speed_trust_.lagDeviation());
  angle_lag_.begin(now_.encoderSpeed());
  speed_trust_ = {};
  errors_ = ConstantErrors(settings_.constant_deviations, settings_.zero_std);
  updateConsidered();
  forgetInertia();
  return true;
}

/// (2) Moves the encoder's zero and discards what was identified with the old one.
bool CrankFilter::applyZero() noexcept {
  if (zero_moves_ == 0.0) return false;
  encoder_.slip(std::exchange(zero_moves_, 0.0));
  errors_ = ConstantErrors(settings_.constant_deviations, settings_.zero_std);
  updateConsidered();
  forgetInertia();
  return true;
}

/// (2) Subtracts the lag from the sample and returns it [rad]. read: angle as it was read [rad].
double CrankFilter::subtractLag(const CrankBelief& last, double dt, bool struck, double read,
                                WeighedSample& sample) const noexcept {
  const double behind = angle_lag_.behind(last.encoderSpeed() + speedJump(struck), now_.encoderSpeed(), dt);
  sample.angle = CrankAngle::wrapToPi(read + behind);
  return behind;
}

/// Returns true if the speed is used. Speeds with a lag or a wrong scale are not. Until this is known, a filter that
/// has restarted with jittering stamps uses its angles alone, because such speeds would cause further restarts and
/// prevent their judgement.
bool CrankFilter::usesSpeeds() noexcept {
  speeds_wait_ = speeds_wait_ && !speed_trust_.isKnown();
  if (HAMMER_LOADS_ABLATE(speed_trust)) return true;
  return speed_trust_.isTrusted() && (HAMMER_LOADS_ABLATE(speeds_wait) || !speeds_wait_);
}

/// Jump of the speed by the blow that was struck within the step [rad/s].
double CrankFilter::speedJump(bool struck) const noexcept {
  return struck ? now_.state.speed * (1.0 - 1.0 / now_.factor) : 0.0;
}

/// (8) Compares the speed with the estimate that does not contain it, except shortly after a restart.
void CrankFilter::judgeSpeed(double dt, bool struck) noexcept {
  if (!comparison_ || std::abs(now_.state.speed) < kLearnSpeed || restart_load_ > kBeganOfLate)
    return speed_trust_.restart();
  comparison_->acceleration = acceleration(load_, now_.state);
  comparison_->jump = speedJump(struck);
  speed_trust_.follow(dt, *comparison_);
}

/// (8)
void CrankFilter::correctSpeed(const WeighedSample& sample, double dt, bool struck) noexcept {
  Innovation innovation = sample.ofSpeed(now_, model_);
  if (sample.of_speed && !HAMMER_LOADS_ABLATE(late_by)) {
    float& by_error = innovation.by_error[ConstantErrors::kSpeedLag];
    const double of_state = now_.encoderByError(Belief::kSpeed)[ConstantErrors::kSpeedLag], before = by_error;
    const double by = -speed_trust_.lateBy(dt, -before, speedJump(struck));
    by_error = static_cast<float>(by);
    innovation.total +=
        (*sample.of_speed)[ConstantErrors::kSpeedLag] * (square(by - of_state) - square(before - of_state));
  }
  fit_ += innovation.logLikelihood();
  // Effects of lag and scale count as noise, which lowers the weight of the speeds.
  const double known = now_.encoderVariance(Belief::kSpeed) + innovation.variance;
  const double squared = std::min(square(innovation.value), square(gate::kImpossible) * known);
  if (!innovation.exceeds(gate::kImpossible))
    now_.correct(Belief::kSpeed, innovation.value, innovation.variance, innovation.by_error, sample.of_speed);
  if (HAMMER_LOADS_ABLATE(speed_noise) || restart_load_ > kBeganOfLate)
    return;  // impossible angles give no information on speeds
  const double floor = square(kLeastSpeedNoise * settings_.speed_noise);
  speed_variance_ = std::max(speed_variance_ + kSpeedNoiseGain * (squared - known), floor);
}

/// (1) Repeats the prediction over another time.
void CrankFilter::predictTo(SampleStep& to, double dt) noexcept {
  now_ = to.last;
  to.dt = dt;
  to.struck = predict(dt, true, now_) > 0;
  to.behind = subtractLag(to.last, dt, to.struck, to.read, to.sample);
  to.innovation = to.sample.ofAngle(now_);
}

/// (5) Detects lost samples before a reading that is impossible for the time between the stamps, but agrees with a time
/// that differs by some intervals.
void CrankFilter::followLostTime(SampleStep& to) noexcept {
  if (HAMMER_LOADS_ABLATE(lost_samples) || !to.innovation.exceeds(gate::kImpossible)) return;
  const double stamped = to.dt;
  for (const double lost : {clock_.suspected_loss, timeLost(stamped, to.innovation)}) {
    if (lost == 0.0 || !clock_.may_have_lost) continue;
    predictTo(to, stamped + lost);
    lost_time_ = lost;
    if (!to.innovation.exceeds(gate::kRare)) return;
    lost_time_ = 0.0;
    predictTo(to, stamped);
  }
}

/// Returns the whole intervals by which the reading is ahead [s], for samples at equal intervals; uses the speed alone.
double CrankFilter::timeLost(double dt, const Innovation& innovation) const noexcept {
  const double speed = now_.encoderSpeed();
  const double interval = clock_.interval;
  if (!(interval > 0.0) || std::abs(speed) < kLearnSpeed || mayBeRod(innovation)) return 0.0;
  const double intervals = innovation.value / (speed * interval), whole = std::nearbyint(intervals);
  const bool counted_before = whole < 0.0 && dt + whole * interval > 0.5 * interval;
  if (!(whole > 0.0 || counted_before) || std::abs(innovation.value) > EncoderSlip::kMost) return 0.0;
  return whole * interval;
}

/// Returns true if an elastic rod may be the cause: of any innovation but a large one well before the blow.
bool CrankFilter::mayBeRod(const Innovation& innovation) const noexcept {
  const CrankAngle& at = now_.state.position.angle;
  const bool calm = at.side == Side::kBeforeBlow && at.offset < -kStrikeBegins;
  return !HAMMER_LOADS_ABLATE(rod_excuse) && rod_evidence_.showsElasticRod() &&
         !(calm && std::abs(innovation.value) > kRodMoves);
}

/// (5) Returns true if a slip can be distinguished from the crank's motion and from the vibration of a rod.
bool CrankFilter::mayHaveSlipped(const WeighedSample& sample, const Innovation& innovation) const noexcept {
  const bool at_work = std::abs(now_.state.speed) > kLearnSpeed && gross_innovations_ < 1.0 && !isLost();
  const double nearest = std::min(std::abs(now_.encoderOffset()), std::abs(sample.angle));
  return !HAMMER_LOADS_ABLATE(slip) && lost_time_ == 0.0 && !mayBeRod(innovation) && at_work && !mirrored_ &&
         !hypothesis_.isOpen() && nearest > kNotSlip;
}

/// (5) Subtracts a detected slip from the reading.
EncoderSlip::Step CrankFilter::followSlip(double dt, const Innovation& innovation, WeighedSample& sample) noexcept {
  // The torque may reverse from one extreme to the other: half its change times the square of the time.
  const double by_torque = square(dt) * settings_.initial_torque_std / now_.state.drive_inertia;
  const double speed = now_.encoderSpeed(), usual = usual_step_.mean();
  const EncoderSlip::Step step = slip_.follow(innovation.value, growth() * innovation.total, by_torque, speed * usual,
                                              speed * (dt - usual), mayHaveSlipped(sample, innovation));
  if (step != EncoderSlip::Step::kSlipped) return step;
  encoder_.slip(slip_.last());
  errors_.stepZero(square(slip_.deviation()));
  sample.angle = CrankAngle::wrapToPi(sample.angle - slip_.last());
  return step;
}

}  // namespace hammer_loads
