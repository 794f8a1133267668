#include "hammer_loads/pipeline/hull_state.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/pipeline/reading_checks.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

/// Returns the motion of a boom's tip due to vibration; zero if the boom is rigid.
HullMotion vibrationOf(const BoomState& boom) noexcept {
  if (!boom.choice.compliant) return {};
  const auto& a = boom.tip.acceleration;  // linear, then angular
  return {{-a[0], -a[2]}, boom.tip.velocity[4], a[4]};
}

/// Returns the covariance of that motion. The angular velocity is negligible and has none.
HullMotionCovariance motionCovariance(const Eigen::Matrix3d& tip) noexcept {
  HullMotionCovariance covariance = HullMotionCovariance::Zero();
  covariance.topLeftCorner<2, 2>() = tip.topLeftCorner<2, 2>();
  covariance(3, 3) = tip(2, 2);
  covariance.topRightCorner<2, 1>() = -tip.topRightCorner<2, 1>();
  covariance.bottomLeftCorner<1, 2>() = -tip.bottomLeftCorner<1, 2>();
  return covariance;
}

}  // namespace

HullPitch::HullPitch(std::vector<std::string> joints, std::vector<int> signs, double offset, double initial)
    : joints_(std::move(joints)),
      signs_(std::move(signs)),
      offset_(offset),
      angles_(joints_.size(), 0.0),
      heard_(joints_.size(), false),
      unheard_(joints_.size()),
      pitch_(initial) {
  signs_.resize(joints_.size(), 1);
}

bool HullPitch::update(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  bool any = false;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto found = std::find(names.begin(), names.end(), joints_[j]);
    if (found == names.end()) continue;
    const auto i = static_cast<std::size_t>(found - names.begin());
    if (i >= positions.size() || !(std::abs(positions[i]) <= kMostAngle)) {
      ++refused_;
      continue;
    }
    angles_[j] = positions[i];
    if (!heard_[j]) --unheard_;
    heard_[j] = true;
    any = true;
  }
  if (any && known()) pitch_ = std::inner_product(angles_.begin(), angles_.end(), signs_.begin(), offset_);
  return any;
}

bool HullPitch::looksLikeDegrees() const noexcept {
  return std::any_of(angles_.begin(), angles_.end(), jointLooksLikeDegrees);
}

std::vector<std::string> HullPitch::unheard() const {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (!heard_[j]) names.push_back(joints_[j]);
  }
  return names;
}

HullGravity::HullGravity(const PipelineSettings& settings, const std::optional<Boom>& boom)
    : pitch_(settings.pitch_joints, settings.pitch_signs, settings.pitch_offset, settings.hull_pitch),
      g_B_(gravityInRoot(settings.gravity, settings.base)),
      chain_(boom ? boom->chain() : settings.pitch_chain) {
  if (chain_) {
    if (!boom && chain_->link(chain_->tip()).name != ChainRequest{}.tip) beyond_ = settings.pitch_offset;
    position_ = JointVector::Zero(chain_->joints());
    zeros_ = boom ? boom->jointZeros() : position_;
    heard_.resize(static_cast<std::size_t>(chain_->joints()));
    if (!settings.pitch_joints.empty()) {
      const PitchOfChain law = pitchOf(*chain_, settings.pitch_joints);
      pitch_is_of_chain_ = !law.joints.empty();
      double zeros = 0.0;
      for (std::size_t i = 0; i < law.joints.size(); ++i)
        zeros += law.signs[i] * zeros_[*chain_->jointIndex(law.joints[i])];
      if (pitch_is_of_chain_)
        pitch_ = HullPitch(law.joints, law.signs, law.offset + beyond_ - zeros, settings.hull_pitch);
    }
  }
  find();
}

bool HullGravity::joints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  const bool of_pitch = pitch_.update(names, positions), of_chain = readPositions(names, positions);
  if (of_pitch || of_chain) find();
  return of_pitch;
}

bool HullGravity::readPositions(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  bool taken = false;
  for (std::size_t i = 0; chain_ && i < names.size() && i < positions.size(); ++i) {
    const std::optional<int> joint = chain_->jointIndex(names[i]);
    if (!joint || !(std::abs(positions[i]) <= HullPitch::kMostAngle)) continue;
    position_[*joint] = positions[i] - zeros_[*joint];
    heard_[static_cast<std::size_t>(*joint)] = true;
    taken = true;
  }
  return taken;
}

bool HullGravity::allHeard() const noexcept { return std::find(heard_.begin(), heard_.end(), false) == heard_.end(); }

void HullGravity::find() noexcept {
  const bool by_chain = chain_ && (allHeard() || (pitch_is_of_chain_ && pitch_.known()));
  const Eigen::Vector3d g = by_chain ? gravityInTip(*chain_, position_, g_B_) : g_B_;
  const double pitch = by_chain ? beyond_ : pitch_.pitch();
  const double s = std::sin(pitch), c = std::cos(pitch);
  gravity_ = {c * g.x() - s * g.z(), s * g.x() + c * g.z()};
}

HullState::HullState(const HammerParameters& hammer, const PipelineSettings& settings, const std::optional<Boom>& boom)
    : source_(settings.hull_motion),
      prior_(hammer),
      weight_(settings, boom),
      imu_(settings.imu),
      filter_(settings.imu, hammer) {
  if (boom && followsLoad()) mobility_.emplace(*boom, settings.imu.position);
  updateGravity();
}

/// Updates the motion from the present joint angles: weight alone, as for a fixed hull.
void HullState::updateGravity() noexcept {
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

/// Returns the covariance due to the variance of the load in the last 2 s, as the boom carries its mean.
HullMotionCovariance HullState::unmeasured() const noexcept {
  return prior_.motion((load_square_.mean() - load_.mean().cwiseAbs2()).cwiseMax(0.0));
}

bool HullState::joints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
  const bool of_pitch = weight_.joints(names, positions);
  updateGravity();
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

/// Returns the filter's motion, or the newest readings' alone if the filter lags behind for lack of crank samples.
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

/// Reduces the acceleration in an overdue reading. Held in full, it would bias the crank's filter and end with a jump.
void HullState::forgetReading(double part) noexcept {
  HullMotion& m = now_.motion;
  const Gravity& weight = weight_.gravity();
  m.gravity = {weight.x + part * (m.gravity.x - weight.x), weight.z + part * (m.gravity.z - weight.z)};
  m.rate *= part, m.acceleration *= part;
  now_.covariance = square(part) * now_.covariance + square(1.0 - part) * usualMotion();
}

/// Returns the covariance of the error of weight alone: from the measured motion, or without an IMU from the expected
/// response to the load.
HullMotionCovariance HullState::usualMotion() const noexcept {
  if (!imu_trust_.isKnown()) return filter_.unread();
  return imu_trust_.power(weight_.gravity()).asDiagonal();
}

void HullState::findByBoom() noexcept {
  const Gravity& weight = weight_.gravity();
  const HullMotion v = vibration_.value_or(HullMotion{});
  now_ = {{{weight.x + v.gravity.x, weight.z + v.gravity.z}, v.rate, v.acceleration},
          vibration_.has_value(),
          vibration_covariance_.value_or(HullMotionCovariance::Zero())};
  if (source_ == HullMotionSource::kImu && !vibration_covariance_) now_.covariance = usualMotion();
}

void HullState::follow(StampNs sample, const WrenchHistory& step, const HullWrench& other_load) noexcept {
  if (!followsLoad()) return;
  filter_.follow(sample, step, other_load);
  find(sample);
}

std::optional<StampedImuReading> HullState::newImuReading(StampNs sample, bool stamps_jitter,
                                                          double most_age) noexcept {
  if (imu_counts_.accepted == imu_taken_ || imu_trust_.isLost()) return std::nullopt;
  imu_taken_ = imu_counts_.accepted;
  const bool is_late = imu_.overdue(sample) > 0.0;
  if (is_late && seconds(sample - imu_.newest().stamp) > most_age) return std::nullopt;
  if (is_late || stamps_jitter) return imu_.newest();
  const std::optional<ImuReading> reading = imu_.reading(sample);
  return reading ? std::make_optional(StampedImuReading{sample, *reading}) : std::nullopt;
}

void HullState::vibrates(const BoomFollower* boom) noexcept {
  if (source_ == HullMotionSource::kFixed || source_ == HullMotionSource::kUnmeasured) return;
  clearVibration();
  const BoomState* state = boom != nullptr ? &boom->state() : nullptr;
  const bool followed = state != nullptr && !state->fault;
  const bool proven = followed && state->choice.compliant && state->identified;
  if (source_ == HullMotionSource::kModel ? followed : proven) {
    vibration_ = vibrationOf(*state);
    if (!by_imu_) vibration_covariance_ = motionCovariance(boom->tipCovariance());
  }
  if (source_ == HullMotionSource::kModel) known_ = vibration_.has_value();
  if (!by_imu_) findByBoom();
}

}  // namespace hammer_loads
