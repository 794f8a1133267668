#include "hammer_loads/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hammer_loads/pipeline/make_tracker.h"

namespace hammer_loads {
namespace {

constexpr double kTrackStep = 1.25e-3;    // [s] between points of a turn at most: 15 of them in the MO-100's pulse
constexpr double kBlowSpeed = 1.0;        // [rad/s] of the crank: slower, it creeps over the blow and nothing strikes
constexpr double kSideOfBlow = 1e-7;      // [s] before and after the blow where its two sides are looked at
constexpr int kSettlingSamples = 5;       // without measured speeds: until then they are known from linearised steps
constexpr double kSettledDeviations = 3;  // predicted error = so many standard deviations

Gravity gravityAtPitch(double g, double pitch) noexcept { return {g * std::sin(pitch), -g * std::cos(pitch)}; }

double seconds(StampNs stamp) noexcept { return static_cast<double>(stamp) * kSecondsPerNs; }

}  // namespace

Pipeline::Pipeline(const Mechanism& mechanism, const PipelineSettings& settings)
    : mechanism_(mechanism),
      settings_(settings),
      hull_model_(mechanism_, settings.level),
      tracker_(makeTracker(mechanism_, settings)),
      hull_pitch_(settings.pitch_joints, settings.hull_pitch),
      gravity_(gravityAtPitch(settings.gravity, settings.hull_pitch)),
      intake_(settings.max_crank_speed, settings.stale_after) {
  tracker_->setGravity(gravity_);
}

bool Pipeline::boomJoints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  if (!hull_pitch_.update(names, positions)) return false;
  gravity_ = gravityAtPitch(settings_.gravity, hull_pitch_.pitch());
  tracker_->setGravity(gravity_);
  return true;
}

const Loads& Pipeline::crankJoint(StampNs stamp, const std::vector<std::string>& names,
                                  const std::vector<double>& positions,
                                  const std::vector<double>& velocities) noexcept {
  loads_.stamp = stamp;
  loads_.turn_ends = 0;
  const auto found = std::find(names.begin(), names.end(), settings_.crank_joint);
  if (found == names.end()) return refuse(Refusal::kMissingJoint);
  const auto i = static_cast<std::size_t>(found - names.begin());
  if (i >= positions.size() || (!velocities.empty() && i >= velocities.size())) return refuse(Refusal::kShortArray);
  return crankSample(stamp, {positions[i], velocities.empty() ? std::nullopt : std::make_optional(velocities[i])});
}

const Loads& Pipeline::refuse(Refusal refusal) noexcept {
  loads_.refusal = refusal;
  ++counts_.refused[static_cast<std::size_t>(refusal)];
  return loads_;
}

const Loads& Pipeline::crankSample(StampNs stamp, const CrankSample& sample) noexcept {
  loads_.stamp = stamp;
  loads_.turn_ends = 0;
  loads_.refusal.reset();
  const Intake::Verdict verdict = intake_.judge(stamp, sample);
  if (verdict.refusal) return refuse(*verdict.refusal);

  if (verdict.order == Intake::Order::kFirst) {
    tracker_->start(sample);
    epoch_ = stamp;
    restart();
  } else {
    const Tracking tracking = tracker_->update(verdict.step, sample);
    if (tracking == Tracking::kOutlier) return refuse(Refusal::kImplausible);
    if (tracking == Tracking::kRestarted) restart();
    if (tracking == Tracking::kContinued && want_turns_) followTurn(verdict.step);
  }
  intake_.accept(stamp);
  speed_measured_ = sample.speed.has_value();
  loads_.crank = tracker_->estimate();
  last_position_ = loads_.crank.position;
  if (!settled()) return refuse(Refusal::kUnsettled);
  loads_.wrench = hullWrench(hull_model_,
                             {loads_.crank.position.angle, loads_.crank.speed, loads_.crank.acceleration}, gravity_);
  ++counts_.accepted;
  return loads_;
}

void Pipeline::restart() noexcept {
  turn_.abandon();
  last_blow_.reset();
  furthest_blow_ = tracker_->estimate().position.blowsPassed();
  unsettled_ = true;
  samples_since_restart_ = 0;
  ++counts_.restarts;
}

/// Before the first whole turn there is no peak to compare with: then only the speed must be known.
bool Pipeline::settled() noexcept {
  if (!unsettled_) return true;
  if (!tracker_->hasSpeed()) return false;
  if (peak_force_ > 0.0 && ++samples_since_restart_ < kSettlingSamples && !speed_measured_) return false;
  if (peak_force_ > 0.0 && kSettledDeviations * wrenchDeviation() > settings_.withhold_above * peak_force_) return false;
  unsettled_ = false;
  return true;
}

/// Standard deviation of the force along the tool [N], by differences of the wrench.
double Pipeline::wrenchDeviation() const noexcept {
  const Eigen::Matrix3d covariance = tracker_->motionCovariance();
  const CrankEstimate& at = loads_.crank;
  const auto force = [&](double angle, double speed, double acceleration) noexcept {
    CrankAngle moved = at.position.angle;
    moved.offset += angle;
    return hullWrench(hull_model_, {moved, at.speed + speed, at.acceleration + acceleration}, gravity_)
        .force_z;
  };
  constexpr double kStep[] = {1e-5, 1e-3, 1e-2};
  const Eigen::Vector3d gradient{(force(kStep[0], 0, 0) - force(-kStep[0], 0, 0)) / (2.0 * kStep[0]),
                                 (force(0, kStep[1], 0) - force(0, -kStep[1], 0)) / (2.0 * kStep[1]),
                                 (force(0, 0, kStep[2]) - force(0, 0, -kStep[2])) / (2.0 * kStep[2])};
  return std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
}

TurnInstant Pipeline::instant(double time, const CrankEstimate& crank) const noexcept {
  const CrankAngle angle = crank.position.angle;
  const HullWrench weight = hullWrench(hull_model_, {angle, 0.0, 0.0}, gravity_);
  return {time, hullWrench(hull_model_, {angle, crank.speed, crank.acceleration}, gravity_),
          linkMomentum(hull_model_, angle, crank.speed), weight.force_x, weight.force_z};
}

/// Points of the turn in (from, to] [s] after the last but one sample.
void Pipeline::recordTo(double from, double to) noexcept {
  if (!turn_.recording() || !(to > from)) return;
  const double origin = seconds(*intake_.last() - epoch_);
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / kTrackStep)));
  for (int i = 1; i <= count; ++i) {
    const double time = i == count ? to : from + (to - from) * i / count;
    turn_.add(instant(origin + time, tracker_->between(time)));
  }
}

void Pipeline::followTurn(double step) noexcept {
  const CrankEstimate now = tracker_->estimate();
  const std::int64_t passed_before = last_position_.blowsPassed(), passed_now = now.position.blowsPassed();
  if (passed_now < passed_before) turn_.abandon();
  double from = 0.0;
  for (std::int64_t blow = passed_before + 1; blow <= passed_now; ++blow) {
    if (blow <= furthest_blow_) continue;
    furthest_blow_ = blow;
    const double time = timeOfBlow(blow, step);
    if (tracker_->between(time).speed < kBlowSpeed) continue;
    recordTo(from, std::max(from, time - kSideOfBlow));
    endTurn(time);
    from = time + kSideOfBlow;
  }
  recordTo(from, step);
}

/// Root of the position by bracketing false position (Illinois) [s after the last but one sample].
double Pipeline::timeOfBlow(std::int64_t blow, double step) const noexcept {
  const CrankPosition at_blow{blow, {0.0, Side::kAfterBlow}};
  double low = 0.0, high = step;
  double f_low = difference(tracker_->between(low).position, at_blow);
  double f_high = difference(tracker_->between(high).position, at_blow);
  constexpr double kAngleTolerance = 1e-11;  // [rad]: some 1e-12 s
  int kept = 0;  // which end stayed last time: +1 high, -1 low
  for (int i = 0; i < 60 && f_high > kAngleTolerance && f_low < -kAngleTolerance; ++i) {
    const double time = (low * f_high - high * f_low) / (f_high - f_low);
    const double f = difference(tracker_->between(time).position, at_blow);
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

void Pipeline::endTurn(double time) noexcept {
  const StampNs stamp = *intake_.last() + static_cast<StampNs>(std::llround(time / kSecondsPerNs));
  const double origin = seconds(*intake_.last() - epoch_);
  CrankEstimate before = tracker_->between(std::max(0.0, time - kSideOfBlow));
  CrankEstimate after = tracker_->between(time + kSideOfBlow);
  before.position.angle = {0.0, Side::kBeforeBlow};
  after.position.angle = {0.0, Side::kAfterBlow};
  ++turns_;
  TurnEnd end;
  end.stamp = stamp;
  end.turn = turns_;
  end.blow = blowAtCrankSpeed(mechanism_, settings_.level, tracker_->between(time).speed);
  end.pulse = turn_.end(instant(origin + time, before));
  if (end.pulse) peak_force_ = end.pulse->amplitude;
  end.mean_press_force = last_blow_ ? end.blow.tool_impulse_z / seconds(stamp - *last_blow_)
                                    : std::numeric_limits<double>::quiet_NaN();
  if (loads_.turn_ends < loads_.ends.size()) loads_.ends[loads_.turn_ends++] = end;
  last_blow_ = stamp;
  turn_.begin(instant(origin + time, after));
}

}  // namespace hammer_loads
