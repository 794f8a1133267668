#include "hammer_loads/boom/vibration_spread.h"

#include <cmath>

#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kSameDeviation = 1e-3;  // relative difference of deviations that count as equal
constexpr double kFaded = 1e-4;          // displacement by the hammer's load [m sqrt(kg)]: 10 kg by 30 um
constexpr double kBelowCritical = 1e-6;  // distance to critical damping, relative
// Numerical: kSameDeviation, kFaded, kBelowCritical

}  // namespace

void VibrationSpread::follow(const Vibration& vibration) noexcept {
  const BoomModes& now = vibration.modes();
  const bool same = now.count == modes_.count && now.count > 0 && now.shape == modes_.shape;
  if (same && !vibration.identifies()) return;  // unchanged
  if (now.count != modes_.count) {
    modes_ = now;
    reset();
  } else if (!same && now.count > 0) {
    for (std::size_t run = 0; run < kMaxRuns; ++run) {
      for (auto* values : {&x_, &v_, &force_}) (*values)[run] = modalOf(now, jointsOf(modes_, (*values)[run]));
    }
    modes_ = now;
  }
  for (int k = 0; k < now.count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    OilDeviation& deviation = deviation_[i];
    deviation = given_;
    if (vibration.identifies()) {
      const ModeIdentifier& found = *vibration.identifier();
      const auto known = [](double variance, double left) { return std::sqrt(variance + square(left)); };
      deviation.frequency =
          std::min(given_.frequency, known(found.frequencyVariance(k), ModeIdentifier::kLeftFrequency));
      deviation.damping = std::min(given_.damping, known(found.dampingVariance(k), ModeIdentifier::kLeftDamping));
    }
    for (auto& modes : mode_) modes[i] = vibration.mode(k);
    Factors& factor = factor_[i];
    if (std::abs(factor.of.frequency - deviation.frequency) > kSameDeviation * deviation.frequency ||
        std::abs(factor.of.damping - deviation.damping) > kSameDeviation * deviation.damping)
      factor = {deviation, std::exp(deviation.frequency), std::exp(-deviation.frequency), std::exp(deviation.damping)};
    mode_[kStiffer][i].omega *= factor.stiffer;
    mode_[kSofter][i].omega *= factor.softer;
    mode_[kDamped][i].zeta = std::min(1.0 - kBelowCritical, mode_[kDamped][i].zeta * factor.damped);
  }
  if (waits_ || vibration.followsReadings()) start(vibration);
  waits_ = vibration.followsReadings();
}

/// Starts the runs from the estimated state when the readings end.
void VibrationSpread::start(const Vibration& vibration) noexcept {
  if (!waits_) reset();
  for (int k = 0; k < modes_.count; ++k) {
    const ModeState now = vibration.motion(k);
    const double load = vibration.loadOn(k);
    for (std::size_t run = 0; run < kLoads; ++run) x_[run][k] = now.x, v_[run][k] = now.v, force_[run][k] = load;
  }
}

void VibrationSpread::reset() noexcept {
  for (auto* values : {&x_, &v_, &force_}) {
    for (JointVector& value : *values) value.setZero(modes_.count);
  }
  load_.resize(modes_.mass.rows(), 0);
  swing_.resize(0);
}

void VibrationSpread::fade(double step) noexcept {
  if (!startsUnknown()) return;
  for (int k = 0; k < modes_.count; ++k) swing_[k] *= std::exp(-mode(kLoads, k).zeta * mode(kLoads, k).omega * step);
  if (swing_.maxCoeff() < kFaded) swing_.resize(0);
}

JointVector VibrationSpread::accelerationOfSwing(int mode) const noexcept {
  JointVector modal = JointVector::Zero(modes_.count);
  modal[mode] = square(this->mode(kLoads, mode).omega) * swing_[mode];
  return jointsOf(modes_, modal);
}

void VibrationSpread::advance(double step, const TorqueStep& torque, const LoadSpread& to) noexcept {
  if (modes_.count == 0 || waits_) return;
  fade(step);
  const bool same = load_.cols() == to.cols();
  const TorqueStep modal = modalForces(modes_, torque);
  load_ = to;
  bool finite = modal.to.allFinite();
  Paths paths;
  for (int k = 0; k < modes_.count; ++k)
    paths[static_cast<std::size_t>(k)] = pathOf({modal.from[k], modal.to[k], modal.mean[k]}, step);
  for (int run = 0; run < kLoads; ++run) {
    force_[static_cast<std::size_t>(run)] = modal.to;
    finite = advanceRun(run, step, paths) && finite;
  }
  const double per_time = step > 0.0 ? 1.0 / step : 0.0;
  for (int run = kLoads; run < runs(); ++run) {
    JointVector& force = force_[static_cast<std::size_t>(run)];
    const JointVector last = modalForce(modes_, to.col(run - kLoads));
    for (int k = 0; k < modes_.count; ++k) {
      const double first = same ? force[k] : last[k];
      paths[static_cast<std::size_t>(k)] = {first, (last[k] - first) * per_time, 0.0};
    }
    force = last;
    finite = advanceRun(run, step, paths) && finite && last.allFinite();
  }
  if (!finite) reset();
}

/// Returns false if the state is no longer finite.
bool VibrationSpread::advanceRun(int run, double step, const Paths& force) noexcept {
  const auto i = static_cast<std::size_t>(run);
  double all = 0.0;
  for (int k = 0; k < modes_.count; ++k) {
    const auto of_mode = static_cast<std::size_t>(k);
    const ModeStep& its = step_[std::min<std::size_t>(i, kLoads)][of_mode].at(mode(run, k), step);
    const ModeState next = advanced(its, {x_[i][k], v_[i][k]}, force[of_mode]);
    x_[i][k] = next.x, v_[i][k] = next.v;
    all += std::abs(next.x) + std::abs(next.v);
  }
  return std::isfinite(all);
}

void VibrationSpread::strike(const JointVector& impulse) noexcept {
  if (modes_.count == 0 || waits_) return;
  for (std::size_t run = 0; run < kLoads; ++run) v_[run] += modalForce(modes_, impulse);
}

JointVector VibrationSpread::accelerationDifference(int run, const JointVector& vibration) const noexcept {
  if (modes_.count == 0) return JointVector::Zero(modes_.mass.rows());
  const auto i = static_cast<std::size_t>(run);
  JointVector modal(modes_.count);
  for (int k = 0; k < modes_.count; ++k) modal[k] = acceleration(mode(run, k), {x_[i][k], v_[i][k]}, force_[i][k]);
  const JointVector joints = jointsOf(modes_, modal);
  return run < kLoads ? JointVector(joints - vibration) : joints;
}

}  // namespace hammer_loads
