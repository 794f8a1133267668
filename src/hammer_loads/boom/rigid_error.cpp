#include "hammer_loads/boom/rigid_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hammer_loads/boom/mode.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {

double rigidError(const BoomModes& modes, double damping_ratio, const JointVector& peak_torque,
                  double pulse_length) noexcept {
  if (!peak_torque.allFinite()) return std::numeric_limits<double>::infinity();
  const double peak = peak_torque.size() > 0 ? peak_torque.cwiseAbs().maxCoeff() : 0.0;
  if (modes.count == 0 || !(peak > 0.0) || !(pulse_length > 0.0)) return 0.0;
  const double mu = kPi / pulse_length;
  const JointVector amplitude = modalForce(modes, peak_torque);
  const auto mode = [&](int k) { return Mode{modes.omega[k], damping_ratio}; };
  std::array<ModeState, kMaxJoints> state;
  double worst = 0.0;
  const auto look = [&](double sine) {
    JointVector acceleration_now(modes.count);
    for (int k = 0; k < modes.count; ++k)
      acceleration_now[k] = acceleration(mode(k), state[static_cast<std::size_t>(k)], amplitude[k] * sine);
    worst = std::max(worst, modes.inertia.lazyProduct(acceleration_now).cwiseAbs().maxCoeff());
  };
  // During the pulse; then over one period of the slowest mode, in steps that resolve the fastest.
  constexpr int kSamples = 64;
  for (int i = 0; i <= kSamples; ++i) {
    for (int k = 0; k < modes.count; ++k)
      state[static_cast<std::size_t>(k)] = halfSineResponse(mode(k), amplitude[k], mu, pulse_length * i / kSamples);
    look(i == kSamples ? 0.0 : std::sin(kPi * i / kSamples));
  }
  const double slowest = kTwoPi / modes.omega[0], fastest = kTwoPi / modes.omega[modes.count - 1];
  const int after = std::clamp(static_cast<int>(32.0 * slowest / fastest), kSamples, 100 * kSamples);
  std::array<ModeStep, kMaxJoints> step;
  for (int k = 0; k < modes.count; ++k) step[static_cast<std::size_t>(k)] = stepOf(mode(k), slowest / after);
  for (int i = 1; i <= after; ++i) {
    for (int k = 0; k < modes.count; ++k) {
      ModeState& now = state[static_cast<std::size_t>(k)];
      now = advancedFreely(step[static_cast<std::size_t>(k)], now);
    }
    look(0.0);
  }
  return worst / peak;
}

}  // namespace hammer_loads
