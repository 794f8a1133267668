#include "hammer_loads/pipeline/hull_state.h"

#include "hammer_loads/pipeline/overdue.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

/// Motion of a boom's tip by vibration; zero if the boom is rigid.
HullMotion vibrationOf(const BoomState& boom) noexcept {
  if (!boom.choice.compliant) return {};
  const auto& a = boom.tip.acceleration;  // linear, then angular
  return {{-a[0], -a[2]}, boom.tip.velocity[4], a[4]};
}

/// Covariance of that motion; the angular velocity is negligible and has none.
HullMotionCovariance doubtOf(const Eigen::Matrix3d& tip) noexcept {
  HullMotionCovariance doubt = HullMotionCovariance::Zero();
  doubt.topLeftCorner<2, 2>() = tip.topLeftCorner<2, 2>();
  doubt(3, 3) = tip(2, 2);
  doubt.topRightCorner<2, 1>() = -tip.topRightCorner<2, 1>();
  doubt.bottomLeftCorner<1, 2>() = -tip.bottomLeftCorner<1, 2>();
  return doubt;
}

}  // namespace

HullState::HullState(const HammerParameters& hammer, const PipelineSettings& settings, const std::optional<Boom>& boom)
    : source_(settings.hull_motion),
      prior_(hammer),
      weight_(settings, boom),
      imu_(settings.imu),
      filter_(settings.imu, hammer) {
  if (boom && followsLoad()) mobility_.emplace(*boom, settings.imu.position);
  weigh();
}

/// Motion by the present joint angles: weight alone, as for a fixed hull.
void HullState::weigh() noexcept {
  pitch_known_ = weight_.pitch().known();
  in_degrees_ = weight_.pitch().looksLikeDegrees();
  if (source_ == HullMotionSource::kFixed) now_ = {weight_.gravity(), false, HullMotionCovariance::Zero()};
  if (source_ == HullMotionSource::kUnmeasured) now_ = {weight_.gravity(), false, unmeasured()};
}

void HullState::carry(const HullWrench& load, double duration) noexcept {
  if (source_ != HullMotionSource::kUnmeasured) return;
  load_.add(vectorOf(load), duration);
  load_square_.add(vectorOf(load).cwiseAbs2(), duration);
  now_.covariance = unmeasured();
}

/// Covariance by the variance of the load in the last 2 s, as the boom carries its mean.
HullMotionCovariance HullState::unmeasured() const noexcept {
  return prior_.motion((load_square_.mean() - load_.mean().cwiseAbs2()).cwiseMax(0.0));
}

bool HullState::joints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  const bool of_pitch = weight_.joints(names, positions);
  weigh();
  const JointVector* position = mobility_ ? weight_.position() : nullptr;
  if (position != nullptr)
    if (const std::optional<HullMobility::Mobility> mobility = mobility_->movedTo(*position)) filter_.expect(*mobility);
  return of_pitch;
}

std::optional<ImuRefusal> HullState::imu(StampNs stamp, const ImuReading& reading) noexcept {
  const StampNs last = imu_.newest().stamp;
  const std::optional<ImuRefusal> refusal = imu_.update(stamp, reading);
  if (!refusal) {
    const StampedImuReading taken = imu_.newest();
    const double step = seconds(stamp - last);
    imu_trust_.follow(taken.reading.specific_force, taken.reading.rate, step);
    if (followsLoad()) filter_.add(taken);
    if (pitch_known_) imu_trust_.judge(weight_.gravity(), step);
  }
  ++(refusal ? imu_counts_.refused[static_cast<std::size_t>(*refusal)] : imu_counts_.accepted);
  return refusal;
}

const HullMotion& HullState::predict(StampNs stamp) noexcept {
  find(stamp);
  imu_counts_.missed += source_ == HullMotionSource::kImu && !known_;
  return now_.motion;
}

/// Motion by the filter, or by the newest readings alone if the filter lags behind for lack of crank samples.
std::optional<KnownHullMotion> HullState::measured(StampNs stamp) const noexcept {
  if (imu_trust_.isLost()) return std::nullopt;
  constexpr std::ptrdiff_t kLeftBehind = 3;  // readings
  if (filter_.waiting(stamp) < kLeftBehind)
    if (const std::optional<KnownHullMotion> known = filter_.at(stamp)) return known;
  const std::optional<HullMotion> read = imu_.at(stamp);
  if (!read) return std::nullopt;
  return KnownHullMotion{*read, usualMotion()};
}

void HullState::find(StampNs stamp) noexcept {
  if (source_ == HullMotionSource::kModel) findByBoom();
  if (source_ != HullMotionSource::kImu) return;
  const std::optional<KnownHullMotion> measured = this->measured(stamp);
  known_ = measured.has_value();
  const double overdue = imu_.overdue(stamp);
  by_imu_ = known_ && !(vibration_ && overdue > 0.0);
  if (!by_imu_) return findByBoom();
  now_ = {measured->motion, true, measured->covariance};
  if (overdue > 0.0 && pitch_known_) forgetReading(1.0 - forgottenPart(overdue));
}

/// Reduces the acceleration in a reading that is held too long. Held in full, it would bias the crank's filter and end
/// with a jump.
void HullState::forgetReading(double part) noexcept {
  HullMotion& m = now_.motion;
  const Gravity& weight = weight_.gravity();
  m.gravity = {weight.x + part * (m.gravity.x - weight.x), weight.z + part * (m.gravity.z - weight.z)};
  m.rate *= part, m.acceleration *= part;
  now_.covariance = square(part) * now_.covariance + square(1.0 - part) * usualMotion();
}

/// Covariance of the error of weight alone: by the measured motion, or without an IMU by the expected response to the
/// load.
HullMotionCovariance HullState::usualMotion() const noexcept {
  if (!imu_trust_.isKnown()) return filter_.unread();
  return imu_trust_.power(weight_.gravity()).asDiagonal();
}

void HullState::findByBoom() noexcept {
  const Gravity& weight = weight_.gravity();
  const HullMotion v = vibration_.value_or(HullMotion{});
  now_ = {{{weight.x + v.gravity.x, weight.z + v.gravity.z}, v.rate, v.acceleration},
          vibration_.has_value(),
          vibration_doubt_.value_or(HullMotionCovariance::Zero())};
  if (source_ == HullMotionSource::kImu && !vibration_doubt_) now_.covariance = usualMotion();
}

void HullState::follow(StampNs sample, const WrenchHistory& step, const HullWrench& beside) noexcept {
  if (!followsLoad()) return;
  filter_.follow(sample, step, beside);
  find(sample);
}

std::optional<StampedImuReading> HullState::newImuReading(StampNs sample, bool stamps_jitter) noexcept {
  if (imu_counts_.accepted == imu_taken_ || imu_trust_.isLost()) return std::nullopt;
  imu_taken_ = imu_counts_.accepted;
  if (stamps_jitter) return imu_.newest();
  const std::optional<ImuReading> reading = imu_.reading(sample);
  return reading ? std::make_optional(StampedImuReading{sample, *reading}) : std::nullopt;
}

void HullState::vibrates(const BoomFollower* boom) noexcept {
  if (source_ == HullMotionSource::kFixed || source_ == HullMotionSource::kUnmeasured) return;
  rest();
  const BoomState* state = boom != nullptr ? &boom->state() : nullptr;
  const bool followed = state != nullptr && !state->fault;
  const bool proven = followed && state->choice.compliant && state->identified;
  if (source_ == HullMotionSource::kModel ? followed : proven) {
    vibration_ = vibrationOf(*state);
    if (!by_imu_) vibration_doubt_ = doubtOf(boom->tipCovariance());
  }
  if (source_ == HullMotionSource::kModel) known_ = vibration_.has_value();
  if (!by_imu_) findByBoom();
}

}  // namespace hammer_loads
