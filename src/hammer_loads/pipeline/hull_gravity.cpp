#include "hammer_loads/pipeline/hull_gravity.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {

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
  const bool of_pitch = pitch_.update(names, positions), of_chain = takePosition(names, positions);
  if (of_pitch || of_chain) find();
  return of_pitch;
}

bool HullGravity::takePosition(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept {
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

}  // namespace hammer_loads
