/// Error of a rigid boom: pulse length against natural frequencies.
#pragma once

#include "hammer_loads/boom/boom_modes.h"

namespace hammer_loads {

/// Largest difference between the joint torques that the vibrating boom holds and the static ones, J^T w, over the
/// largest of the latter [-], for one half-sine pulse of that peak (joint torques [N m]) and length [s] on a boom at
/// rest. Small when the pulse is long against the longest period; about 1 when it is short: then impulse times natural
/// frequency, not the peak, is what the joints hold. Sampled, good to 1 %. 0 without modes or torque,
/// infinity for one that is not finite.
/// Neglects: vibration by earlier pulses (blow rate near a natural frequency).
double rigidError(const BoomModes& modes, double damping_ratio, const JointVector& peak_torque,
                  double pulse_length) noexcept;

}  // namespace hammer_loads
