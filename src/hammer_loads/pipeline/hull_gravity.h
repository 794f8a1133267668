/// Gravity in the hull's axes, by the latest joint angles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/boom/gravity.h"
#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/pipeline/hull_pitch.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// With a boom, or a description that has the pitch joints, by its axes, zeros, fixed tilts and swing, once every pitch
/// joint has been heard: joints beside these are at zero until they are heard. Else by the sum of the pitch joints.
class HullGravity {
 public:
  HullGravity(const PipelineSettings& settings, const std::optional<Boom>& boom);

  /// Takes boom joint angles, any subset in any order. Returns true if any was used.
  bool joints(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;

  /// Positions of the chain's joints once all of them have been received; null before, or without a chain.
  const JointVector* position() const noexcept { return chain_ && allHeard() ? &position_ : nullptr; }
  const Gravity& gravity() const noexcept { return gravity_; }  ///< hull axes [m/s2]
  const HullPitch& pitch() const noexcept { return pitch_; }

 private:
  bool takePosition(const std::vector<std::string>& names, const std::vector<double>& positions) noexcept;
  void find() noexcept;
  bool allHeard() const noexcept;

  HullPitch pitch_;
  Eigen::Vector3d g_B_;  ///< in the root's axes [m/s2]
  std::optional<Chain> chain_;
  double beyond_{};           ///< pitch of the hull against the chain's tip [rad]
  JointVector zeros_;         ///< readings at the chain's zeros
  JointVector position_;      ///< positions of the chain's joints; zero: not received
  std::vector<bool> heard_;   ///< true for each joint that was received
  bool pitch_is_of_chain_{};  ///< the pitch joints are joints of the chain
  Gravity gravity_;
};

}  // namespace hammer_loads
