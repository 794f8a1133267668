#include "hammer_loads/boom/load_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hammer_loads/boom/mode.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/known_count.h"

namespace hammer_loads {
namespace {

Eigen::Vector3d across(const Wrench& w) noexcept { return {w.force.y(), w.torque.x(), w.torque.z()}; }

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

LoadErrors::LoadErrors(const std::vector<Cylinder>& cylinders) noexcept : held_(static_cast<int>(cylinders.size())) {
  covariance_.leftCols(held_ + 6).setZero();
  for (std::size_t i = 0; i < cylinders.size(); ++i) joint_[i] = cylinders[i].joint();
}

LoadErrors::Inputs LoadErrors::inputsOf(const JointVector& acceleration) const noexcept {
  Inputs inputs = Inputs::Zero();
  for (int i = 0; i < held_; ++i) inputs[i] = acceleration[joint_[static_cast<std::size_t>(i)]];
  return inputs;
}

void LoadErrors::setTip(const Wrench& tip, Inputs& inputs) noexcept {
  inputs.segment<3>(held_) = inPlane(tip), inputs.segment<3>(held_ + 3) = across(tip);
  across_ = across_ || !across(tip).isZero(0.0);
}

/// one other^T, symmetric in the sum of all that is added.
void LoadErrors::addProduct(const Inputs& one, const Inputs& other) noexcept {
  withCount<kUsualInputs>(size(), [&](auto end) {
    for (int c = 0; c < end; ++c) {
      for (int r = c; r < end; ++r) covariance_(r, c) += one[r] * other[c];
    }
  });
}

void LoadErrors::add(const JointVector& acceleration, const Wrench& tip) noexcept {
  Inputs inputs = inputsOf(acceleration);
  setTip(tip, inputs);
  addProduct(inputs, inputs);
}

void LoadErrors::addInPlane(const Eigen::Vector3d& tip) noexcept {
  for (int c = 0; c < 3; ++c) {
    for (int r = c; r < 3; ++r) covariance_(held_ + r, held_ + c) += tip[r] * tip[c];
  }
}

void LoadErrors::add(const BoomModes& modes, const JointMatrix& covariance,
                     const std::array<Eigen::Vector3d, kMaxJoints>& tip) noexcept {
  std::array<Inputs, kMaxJoints> by_mode;
  for (int k = 0; k < modes.count; ++k) {
    Inputs& inputs = by_mode[static_cast<std::size_t>(k)];
    for (int i = 0; i < held_; ++i) inputs[i] = modes.shape(i, k);
    inputs.segment<3>(held_) = tip[static_cast<std::size_t>(k)];
    inputs.segment<3>(held_ + 3).setZero();
  }
  for (int k = 0; k < modes.count; ++k) {
    Inputs with = Inputs::Zero();  // covariance of the inputs with mode k
    withCount<kUsualInputs>(size(), [&](auto end) {
      for (int l = 0; l < modes.count; ++l) {
        for (int r = 0; r < end; ++r) with[r] += covariance(l, k) * by_mode[static_cast<std::size_t>(l)][r];
      }
    });
    addProduct(with, by_mode[static_cast<std::size_t>(k)]);
  }
}

void LoadErrors::addLarger(const JointVector& acceleration, const JointVector& other) noexcept {
  larger_ = {inputsOf(acceleration), inputsOf(other)};
  has_larger_ = true;
}

void LoadErrors::findVariances(const Eigen::Ref<const Eigen::MatrixXd>& response,
                               Eigen::Ref<Eigen::VectorXd> variance) const noexcept {
  const Eigen::Index inputs = size();
  variance.setZero();
  for (Eigen::Index k = 0; k < inputs; ++k) {
    const Eigen::Index after = inputs - k - 1;
    const auto& column = covariance_.col(k);
    variance.array() +=
        response.col(k).array() *
        (column[k] * response.col(k) + 2.0 * response.rightCols(after).lazyProduct(column.segment(k + 1, after)))
            .array();
  }
  // Not cwiseMax(), which loses a not-a-number with Eigen 3.3.
  variance = (variance.array() < 0.0).select(0.0, variance);
  if (!has_larger_) return;
  const auto squares = [&](const Inputs& one) { return (response.lazyProduct(one.head(inputs))).cwiseAbs2(); };
  variance += squares(larger_[0]).cwiseMax(squares(larger_[1]));
}

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
