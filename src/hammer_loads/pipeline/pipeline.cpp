#include "hammer_loads/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hammer_loads/pipeline/make_tracker.h"
#include "hammer_loads/pipeline/step_impulse.h"

namespace hammer_loads {
namespace {

constexpr double kTrackStep = 1.25e-3;    // [s] between points of a turn at most: 15 of them in the MO-100's pulse
constexpr double kSideOfBlow = 1e-7;      // [s] before and after the blow where its two sides are looked at
constexpr int kSettlingSamples = 5;       // without measured speeds: until then they are known from linearised steps
constexpr double kSettledDeviations = 3;  // predicted error = so many standard deviations
constexpr double kFrozenCounts = 5;       // a crank that turned further gives another angle
constexpr double kFrozenDeviations = 5;   // of a sensor's noise, likewise

/// A hull that has the boom's vibration: of none, if the boom is rigid or not known.
HullMotion withVibration(Gravity weight, const BoomState* boom) noexcept {
  if (boom == nullptr || boom->fault || !boom->choice.compliant) return weight;
  const auto& a = boom->tip.acceleration;  // linear, then angular
  return {{weight.x - a[0], weight.z - a[2]}, boom->tip.velocity[4], a[4]};
}

/// resolution: of the angle sensor [rad].
double frozenTurn(const PipelineSettings& s, double resolution) noexcept {
  // The trackers for comparison take every reading as it is.
  if (s.crank_estimator != CrankEstimator::kMechanism) return std::numeric_limits<double>::infinity();
  return kFrozenCounts * resolution + kFrozenDeviations * s.crank_angle_noise;
}

Intake::Limits limitsOf(const PipelineSettings& s, double resolution) noexcept {
  return {s.max_crank_speed, s.stale_after, frozenTurn(s, resolution), kFrozenDeviations * s.crank_speed_noise};
}

double seconds(StampNs stamp) noexcept { return static_cast<double>(stamp) * kSecondsPerNs; }

}  // namespace

Pipeline::Pipeline(const Mechanism& mechanism, const PipelineSettings& settings, const std::optional<Boom>& boom,
                   const IntakeCounts& counts)
    : mechanism_(mechanism),
      settings_(settings),
      hull_model_(mechanism_, settings.level),
      tracker_(makeTracker(mechanism_, settings)),
      hull_pitch_(settings.pitch_joints, settings.hull_pitch),
      imu_(settings.imu),
      unit_check_(settings.max_crank_speed),
      sequence_(settings.crank_stamps, settings.stale_after),
      intake_(limitsOf(settings, tracker_->angleResolution())),
      step_(*tracker_),
      outputs_(hull_model_, step_, settings),
      counts_(counts) {
  if (boom) boom_.emplace(*boom, settings, mechanism.parameters().striking_distance);
  takePitch();
}

/// The weight by the latest pitch; of a fixed hull that is all its motion.
void Pipeline::takePitch() noexcept {
  const double pitch = hull_pitch_.pitch();
  weight_ = {settings_.gravity * std::sin(pitch), -settings_.gravity * std::cos(pitch)};
  if (settings_.hull_motion != HullMotionSource::kFixed) return;
  hull_ = weight_;
  tracker_->setHullMotion(hull_);
}

bool Pipeline::boomJoints(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                          const std::vector<double>& velocities) noexcept {
  const bool of_boom = boom_ && boom_->jointStates(stamp, names, positions, velocities);
  if (!hull_pitch_.update(names, positions)) return of_boom;
  takePitch();
  return true;
}

std::optional<ImuRefusal> Pipeline::hullImu(StampNs stamp, const ImuReading& reading) noexcept {
  const std::optional<ImuRefusal> refusal = imu_.update(stamp, reading);
  ++(refusal ? imu_counts_.refused[static_cast<std::size_t>(*refusal)] : imu_counts_.accepted);
  return refusal;
}

/// The hull's motion at a sample as far as it is known before the sample is: the boom's vibration from the one before.
void Pipeline::predictHull(StampNs stamp) noexcept {
  if (settings_.hull_motion == HullMotionSource::kFixed) return;
  hull_known_ = true;
  if (settings_.hull_motion == HullMotionSource::kImu) {
    const std::optional<HullMotion> measured = imu_.at(stamp);
    hull_known_ = measured.has_value();
    imu_counts_.missed += !hull_known_;
    hull_ = measured.value_or(HullMotion(weight_));
  } else {
    hull_ = withVibration(weight_, loads_.boom);
  }
  tracker_->setHullMotion(hull_);
}

const Loads& Pipeline::crankJoint(StampNs stamp, const std::vector<std::string>& names,
                                  const std::vector<double>& positions,
                                  const std::vector<double>& velocities) noexcept {
  loads_.stamp = loads_.sample_stamp = stamp;
  loads_.turn_ends = 0;
  const auto found = std::find(names.begin(), names.end(), settings_.crank_joint);
  if (found == names.end()) return refuse(Refusal::kMissingJoint);
  const auto i = static_cast<std::size_t>(found - names.begin());
  if (i >= positions.size() || (!velocities.empty() && i >= velocities.size())) return refuse(Refusal::kShortArray);
  return crankSample(stamp, {positions[i], velocities.empty() ? std::nullopt : std::make_optional(velocities[i])});
}

const Loads& Pipeline::refuse(Refusal refusal) noexcept {
  loads_.refusal = refusal;
  loads_.boom = nullptr;
  ++counts_.refused[static_cast<std::size_t>(refusal)];
  return loads_;
}

const Loads& Pipeline::crankSample(StampNs header, const CrankSample& measured) noexcept {
  loads_.turn_ends = 0;
  loads_.refusal.reset();
  loads_.stamp = loads_.sample_stamp = header;
  if (const std::optional<Refusal> refusal = intake_.refusalOf(measured)) {
    unit_check_.add(last_raw_stamp_ ? seconds(header - *last_raw_stamp_) : 0.0, measured.angle, measured.speed);
    last_raw_stamp_ = header;
    return refuse(*refusal);
  }
  const bool repeats = measured.angle == last_raw_.angle && measured.speed == last_raw_.speed;
  last_raw_ = measured;
  const StampSequence::Place place = sequence_.place(header, repeats);
  const StampNs stamp = loads_.stamp = place.stamp;
  if (place.kind == StampSequence::Kind::kDuplicate) return refuse(Refusal::kDuplicate);
  if (place.kind == StampSequence::Kind::kOutOfOrder) return refuse(Refusal::kOutOfOrder);
  unit_check_.add(last_raw_stamp_ ? seconds(stamp - *last_raw_stamp_) : 0.0, measured.angle, measured.speed);
  last_raw_stamp_ = stamp;
  const Intake::Verdict verdict = intake_.judge(stamp, measured);
  if (verdict.refusal) return refuse(*verdict.refusal);
  const CrankSample sample{measured.angle, verdict.speed_is_dead ? std::nullopt : measured.speed};

  predictHull(stamp);
  if (verdict.order == Intake::Order::kFirst) {
    tracker_->start(sample);
    loads_.crank = tracker_->estimate();
    tellBlow();
    epoch_ = stamp;
    restart();
    speed_measured_ = sample.speed.has_value();
  } else {
    const Tracking tracking = tracker_->update(verdict.step, sample);
    if (tracking == Tracking::kOutlier) return refuse(Refusal::kImplausible);
    if (tracking == Tracking::kRestarted) tellBlow(), restart(), speed_measured_ = false;
    if (tracking == Tracking::kRevised) restart(), speed_measured_ = false;
    loads_.crank = tracker_->estimate();
    if (tracking == Tracking::kContinued) {
      step_.take(*intake_.last(), verdict.step, last_position_);
      if (want_turns_ || boom_) followTurn();
    }
  }
  intake_.accept(stamp, measured);
  intake_.setFrozenTurn(frozenTurn(settings_, tracker_->angleResolution()));
  last_position_ = loads_.crank.position;
  const bool doubtful = tracker_->isDoubtful();
  if (doubtful) outputs_.forget();
  if (!settled() || doubtful) {
    boom_follows_ = false;
    return refuse(Refusal::kUnsettled);
  }
  followBoom(stamp);
  if (settings_.hull_motion == HullMotionSource::kModel) {
    hull_known_ = loads_.boom != nullptr && !loads_.boom->fault;
    hull_ = withVibration(weight_, loads_.boom);
  }
  loads_.wrench = hullWrench(hull_model_, motionOf(loads_.crank), hull_);
  outputs_.sample(stamp, loads_.crank, loads_.wrench, hull_);
  ++counts_.accepted;
  return loads_;
}

void Pipeline::followBoom(StampNs stamp) noexcept {
  loads_.boom = nullptr;
  const bool wanted = want_boom_ || settings_.hull_motion == HullMotionSource::kModel;
  if (!boom_ || !wanted) {
    boom_follows_ = false;
    return;
  }
  const HullWrench motion = hullWrench(hull_model_, motionOf(loads_.crank), Gravity{});
  const LoadStep step = boom_follows_ ? loadStep(hull_model_, step_) : LoadStep{};
  loads_.boom = &boom_->sample({stamp, motion, settings_.gravity}, step);
  boom_follows_ = true;
  for (std::size_t i = 0; i < loads_.turn_ends; ++i)
    boom_->turnEnded(loads_.ends[i].pulse, loads_.ends[i].mean_press_force);
}

/// The pending blow stays: whether it was one shows later.
void Pipeline::restart() noexcept {
  step_.forget(tracker_->estimate().position);
  outputs_.forget();
  boom_follows_ = false;
  turn_.abandon();
  last_blow_.reset();
  unsettled_ = true;
  samples_since_restart_ = 0;
  ++counts_.restarts;
}

/// Before the first whole turn there is no peak to compare with: then only the speed must be known.
bool Pipeline::settled() noexcept {
  if (!unsettled_) return true;
  if (!tracker_->hasSpeed()) return false;
  if (peak_force_ > 0.0 && ++samples_since_restart_ < kSettlingSamples && !speed_measured_) return false;
  if (peak_force_ > 0.0) {
    const double deviation =
        hullDeviation(hull_model_, loads_.crank, hull_, tracker_->motionCovariance(1.0)).wrench.force_z;
    if (kSettledDeviations * deviation > settings_.withhold_above * peak_force_) return false;
  }
  unsettled_ = false;
  return true;
}

HullDeviation Pipeline::deviation(const HullOutput& output) noexcept {
  const bool at_sample = output.stamp == loads_.stamp;
  const Eigen::Matrix3d covariance =
      at_sample ? tracker_->motionCovariance(settings_.torque_deviation_part)
                : tracker_->covarianceBetween(seconds(output.stamp - step_.start()), settings_.torque_deviation_part);
  HullDeviation result = hullDeviation(hull_model_, output.crank, hull_, covariance);
  if (settings_.output != OutputKind::kMean) return result;
  const HullWrench momentum = momentumDeviation(hull_model_, output.crank, covariance);
  const HullWrench allowed = (1.0 / output.interval) * (last_momentum_deviation_ + momentum);
  last_momentum_deviation_ = momentum;
  result.wrench = {std::fmin(result.wrench.force_x, allowed.force_x), std::fmin(result.wrench.force_z, allowed.force_z),
                   std::fmin(result.wrench.torque_y, allowed.torque_y)};
  return result;
}

TurnInstant Pipeline::instant(double time, const CrankEstimate& crank) const noexcept {
  const CrankMotion motion = motionOf(crank);
  const HullWrench added = frameWrench(hull_model_, motion.angle, motion.speed, hull_);
  return {time, hullWrench(hull_model_, motion, hull_), linkMomentum(hull_model_, motion.angle, motion.speed),
          added.force_x, added.force_z};
}

/// Points of the turn in (from, to] [s] after the step's start.
void Pipeline::recordTo(double from, double to) noexcept {
  if (!turn_.recording() || !(to > from)) return;
  const double origin = seconds(step_.start() - epoch_);
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / kTrackStep)));
  for (int i = 1; i <= count; ++i) {
    const double time = i == count ? to : from + (to - from) * i / count;
    turn_.add(instant(origin + time, step_.at(time)));
  }
}

void Pipeline::followTurn() noexcept {
  if (loads_.crank.position.blowsPassed() < last_position_.blowsPassed()) turn_.abandon();
  double from = 0.0;
  for (const CrankStep::Passage& passage : step_) {
    if (!passage.may_strike) continue;
    recordTo(from, std::max(from, passage.time - kSideOfBlow));
    tellBlow();
    endTurn(passage);
    from = passage.time + kSideOfBlow;
  }
  recordTo(from, step_.length());
  if (pending_.isWaiting()) pending_.follow(tracker_->blowFactor());
  const double now = seconds(step_.start() - epoch_) + step_.length();
  if (pending_.isMeasured(now, loads_.crank.position)) tellBlow();
}

/// The turn ends now; what the blow was shows later.
void Pipeline::endTurn(const CrankStep::Passage& passage) noexcept {
  const StampNs stamp = step_.start() + static_cast<StampNs>(std::llround(passage.time / kSecondsPerNs));
  const double time = seconds(step_.start() - epoch_) + passage.time;
  ++turns_;
  TurnEnd end;
  end.stamp = stamp;
  end.turn = turns_;
  end.pulse = turn_.end(instant(time, step_.besides(passage, Side::kBeforeBlow)));
  if (end.pulse) peak_force_ = end.pulse->amplitude;
  end.mean_press_force =
      last_blow_ ? 1.0 / seconds(stamp - *last_blow_) : std::numeric_limits<double>::quiet_NaN();  // times the impulse
  const double deviation = std::sqrt(tracker_->covarianceBetween(std::max(0.0, passage.time - kSideOfBlow), 1.0)(1, 1));
  pending_end_ = end;
  pending_.begin(time, {passage.blow, {0.0, Side::kAfterBlow}}, passage.speed_before, deviation);
  pending_.follow(tracker_->blowFactor());
  last_blow_ = stamp;
  turn_.begin(instant(time, step_.besides(passage, Side::kAfterBlow)));
}

/// The pending blow, as it is known by now.
void Pipeline::tellBlow() noexcept {
  if (!pending_.isWaiting()) return;
  if (tracker_->estimate().position.isMirrored()) {  // there was no tool
    pending_.drop();
    turn_.abandon();
    last_blow_.reset();
    --turns_;
    return;
  }
  turn_.correctBegin(linkMomentum(hull_model_, {0.0, Side::kAfterBlow}, pending_.crankSpeedAfter()));
  const CrankBlow crank = pending_.take();
  pending_end_.blow = crank.drive_inertia > 0.0 ? measuredBlow(mechanism_, settings_.level, crank)
                                                : blowAtCrankSpeed(mechanism_, settings_.level, crank.speed);
  pending_end_.mean_press_force *= pending_end_.blow.tool_impulse_z;
  if (loads_.turn_ends < loads_.ends.size()) loads_.ends[loads_.turn_ends++] = pending_end_;
}

}  // namespace hammer_loads
