#include "hammer_loads/boom/rigid_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hammer_loads/boom/mode.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads {
namespace {

/// Step of a mode under a force sin(mu t) from any phase: its free transition and its responses to sine and cosine from
/// rest.
struct PulseStep {
  ModeStep itself;
  ModeState by_sine, by_cosine;  ///< the cosine is the sine's derivative over mu, and so is its response

  PulseStep() = default;
  PulseStep(const Mode& mode, double mu, double h) noexcept
      : itself(stepOf(mode, h)), by_sine(halfSineResponse(mode, 1.0, mu, h)) {
    by_cosine = {by_sine.v / mu, acceleration(mode, by_sine, std::sin(mu * h)) / mu};
  }
  /// sine, cosine: of the force at the step's begin.
  ModeState after(const ModeState& now, double sine, double cosine) const noexcept {
    const ModeState next = advancedFreely(itself, now);
    return {next.x + cosine * by_sine.x + sine * by_cosine.x, next.v + cosine * by_sine.v + sine * by_cosine.v};
  }
};

}  // namespace

double rigidError(const BoomModes& modes, double damping_ratio, const JointVector& peak_torque,
                  double pulse_length) noexcept {
  if (!peak_torque.allFinite()) return std::numeric_limits<double>::infinity();
  const double peak = peak_torque.size() > 0 ? peak_torque.cwiseAbs().maxCoeff() : 0.0;
  if (modes.count == 0 || !(peak > 0.0) || !(pulse_length > 0.0)) return 0.0;
  const double mu = kPi / pulse_length;
  const JointVector amplitude = modalForce(modes, peak_torque);
  const auto mode = [&](int k) { return Mode{modes.omega[k], damping_ratio}; };
  std::array<ModeState, kMaxJoints> state{};
  double worst = 0.0;
  const auto look = [&](double sine) {
    JointVector acceleration_now(modes.count);
    for (int k = 0; k < modes.count; ++k)
      acceleration_now[k] = acceleration(mode(k), state[static_cast<std::size_t>(k)], amplitude[k] * sine);
    worst = std::max(worst, modes.inertia.lazyProduct(acceleration_now).cwiseAbs().maxCoeff());
  };
  // During the pulse; then over one period of the slowest mode, in steps that resolve the fastest.
  constexpr int kSamples = 64;
  constexpr double kOfFastest = 32.0;
  // Numerical: kSamples, kOfFastest
  std::array<PulseStep, kMaxJoints> pulse_step;
  for (int k = 0; k < modes.count; ++k)
    pulse_step[static_cast<std::size_t>(k)] = PulseStep(mode(k), mu, pulse_length / kSamples);
  const double step_sine = std::sin(kPi / kSamples), step_cosine = std::cos(kPi / kSamples);
  double sine = 0.0, cosine = 1.0;
  for (int i = 1; i <= kSamples; ++i) {
    for (int k = 0; k < modes.count; ++k) {
      ModeState& now = state[static_cast<std::size_t>(k)];
      now = pulse_step[static_cast<std::size_t>(k)].after(now, amplitude[k] * sine, amplitude[k] * cosine);
    }
    const double before = sine;
    sine = step_cosine * before + step_sine * cosine, cosine = step_cosine * cosine - step_sine * before;
    look(i == kSamples ? 0.0 : sine);
  }
  const double slowest = kTwoPi / modes.omega[0], fastest = kTwoPi / modes.omega[modes.count - 1];
  const int after = std::clamp(static_cast<int>(kOfFastest * slowest / fastest), kSamples, 100 * kSamples);
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
