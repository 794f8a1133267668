/// Uncertainty of the vibration by the stiffness and damping of the oil and by errors of the load.
#pragma once

#include <algorithm>
#include <array>

#include "hammer_loads/boom/mode.h"
#include "hammer_loads/boom/vibration.h"

namespace hammer_loads {

/// Independent and lasting errors of the hammer's load, such as that of an encoder's zero, one standard deviation each.
/// Columns: joint torques of each [N m].
using LoadSpread = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, 4>;

/// Perturbed runs beside a Vibration, with its steps: one run for each uncertain quantity. They are not linearised in
/// the frequency, whose error changes phases. While readings determine the vibration, its own covariance is better: the
/// runs wait and later start from its state. No allocation.
class VibrationSpread {
 public:
  static constexpr int kStiffer = 0, kSofter = 1, kDamped = 2, kLoads = 3, kMaxRuns = 7;

  explicit VibrationSpread(const OilDeviation& given = {}) : given_(given) {}

  /// Takes the modes after Vibration::setPose() and, if they are identified, their standard deviations.
  void follow(const Vibration& vibration) noexcept;
  /// Advances as Vibration::advance(). The errors of the load are those at the step's end, and linear over the step.
  void advance(double step, const TorqueStep& torque, const LoadSpread& to) noexcept;
  void strike(const JointVector& impulse) noexcept;
  void reset() noexcept;
  /// Sets the estimated vibration to rest, with an unknown decaying vibration of each mode at any phase. swing:
  /// standard deviations [m sqrt(kg)].
  void begin(const JointVector& swing) noexcept { swing_ = swing; }

  /// Pauses the runs while readings determine the vibration: advance() has no effect.
  bool waits() const noexcept { return waits_; }
  /// Standard deviation of a mode: the smaller one of the given and the identified.
  const OilDeviation& deviation(int mode) const noexcept { return deviation_[static_cast<std::size_t>(mode)]; }
  int runs() const noexcept { return kLoads + static_cast<int>(load_.cols()); }
  /// Difference of the joints' accelerations of a run from those of the vibration at the same instant [rad/s2].
  JointVector accelerationDifference(int run, const JointVector& vibration) const noexcept;
  /// Returns true if an unknown vibration existed when the runs began.
  bool startsUnknown() const noexcept { return swing_.size() > 0; }
  /// Standard deviation of the joints' accelerations by that unknown vibration, of one mode [rad/s2].
  JointVector accelerationOfSwing(int mode) const noexcept;
  int modes() const noexcept { return modes_.count; }

 private:
  const Mode& mode(int run, int k) const noexcept {
    return mode_[static_cast<std::size_t>(std::min(run, kLoads))][static_cast<std::size_t>(k)];
  }

  void start(const Vibration& vibration) noexcept;
  void fade(double step) noexcept;
  using Paths = std::array<ForcePath, kMaxJoints>;
  bool advanceRun(int run, double step, const Paths& force) noexcept;

  OilDeviation given_;
  std::array<OilDeviation, kMaxJoints> deviation_;
  struct Factors {
    OilDeviation of{0.0, 0.0};
    double stiffer{1.0}, softer{1.0}, damped{1.0};  ///< exponentials of it
  };
  std::array<Factors, kMaxJoints> factor_;
  BoomModes modes_;
  bool waits_{};
  std::array<std::array<Mode, kMaxJoints>, kLoads + 1> mode_;  ///< modes of the first runs; last: the vibration's
  std::array<JointVector, kMaxRuns> x_, v_, force_;            ///< modal, of each run
  LoadSpread load_;
  JointVector swing_;                                              ///< empty: none
  std::array<std::array<KeptStep, kMaxJoints>, kLoads + 1> step_;  ///< last steps, index as mode_
};

}  // namespace hammer_loads
