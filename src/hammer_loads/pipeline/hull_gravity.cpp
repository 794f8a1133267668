#include "hammer_loads/pipeline/hull_gravity.h"

#include <cmath>
#include <limits>

namespace hammer_loads {

HullGravity::HullGravity(const PipelineSettings& settings, const std::optional<Boom>& boom)
    : pitch_(settings.pitch_joints, settings.hull_pitch), g_B_(gravityInRoot(settings.gravity, settings.base)) {
  if (boom) {
    chain_ = boom->chain();
    position_ = JointVector::Constant(chain_->joints(), std::numeric_limits<double>::quiet_NaN());
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
    position_[*joint] = positions[i];
    taken = true;
  }
  return taken;
}

void HullGravity::find() noexcept {
  if (chain_ && position_.allFinite()) {
    const Eigen::Vector3d g_T = gravityInTip(*chain_, position_, g_B_);
    gravity_ = {g_T.x(), g_T.z()};
    return;
  }
  const double s = std::sin(pitch_.pitch()), c = std::cos(pitch_.pitch());
  gravity_ = {c * g_B_.x() - s * g_B_.z(), s * g_B_.x() + c * g_B_.z()};
}

}  // namespace hammer_loads
