// What is known of the oil: frequencies and damping of the modes.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/growth.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kKnown = 0.03;     // deviation of log frequency of a mode that is known
constexpr double kOwnOil = 0.005;   // of log frequency: cylinders whose oil differs from the others'
constexpr double kMostRatio = 1.0;  // of log frequency: e
constexpr double kMostEarly = 0.004, kMostLate = 0.01;  // [s]

}  // namespace

double ModeIdentifier::frequencyVariance(int mode) const noexcept {
  return covariance_(at(mode, kFrequency), at(mode, kFrequency));
}

double ModeIdentifier::dampingVariance(int mode) const noexcept {
  return covariance_(at(mode, kDamping), at(mode, kDamping));
}

bool ModeIdentifier::identified() const noexcept {
  for (int k = 0; k < count_; ++k) {
    if (!(frequencyVariance(k) < square(kKnown))) return false;
  }
  return count_ > 0;
}

double ModeIdentifier::oilDifference() const noexcept {
  double sum = 0.0, weights = 0.0;
  for (int k = 0; k < count_; ++k) {
    const double by_oil = 0.5 * modes_.oil_share[k];
    const double weight = by_oil / (covariance_(at(k, kFrequency), at(k, kFrequency)) + square(kOwnOil));
    sum += weight * state_[at(k, kFrequency)];
    weights += weight * by_oil;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

void ModeIdentifier::forgetOil() noexcept {
  forget(kDelays, 0.0), forget(kDelays + 1, 0.0);
  least_delay_ = {};
  known_for_ = lost_for_ = crank_lead_ = 0.0;
  for (int k = 0; k < kMaxJoints; ++k) {
    forget(at(k, kFrequency), 0.0);
    forget(at(k, kDamping), 0.0);
  }
  ratio_.fill(1.0), used_frequency_.fill(0.0);
  damping_.fill(damping_ratio_), used_damping_.fill(0.0);
  setFirstGuesses();
}

/// Frequencies, damping and delay of the state, within bounds.
void ModeIdentifier::useOil() noexcept {
  for (int k = 0; k < count_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    double &frequency = state_[at(k, kFrequency)], &damping = state_[at(k, kDamping)];
    frequency = std::clamp(frequency, -kMostRatio, kMostRatio);
    damping = std::clamp(damping, least_damping_, most_damping_);
    ratio_[i] *= growth(frequency - used_frequency_[i]), used_frequency_[i] = frequency;
    damping_[i] *= growth(damping - used_damping_[i]), used_damping_[i] = damping;
  }
  for (int i : {kDelays, kDelays + 1}) state_[i] = std::clamp(state_[i], -kMostEarly, kMostLate);
}

}  // namespace hammer_loads
