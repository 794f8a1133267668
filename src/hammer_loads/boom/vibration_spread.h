/// Uncertainty of the vibration: the same hammer on oil that is stiffer, softer or more damped, and errors of its load.
#pragma once

#include <algorithm>
#include <array>

#include "hammer_loads/boom/mode.h"
#include "hammer_loads/boom/vibration.h"

namespace hammer_loads {

/// Errors of the hammer's load that are independent of each other, one standard deviation each; they last, as that of
/// an encoder's zero does. Columns: joint torques of each [N m].
using LoadSpread = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, 4>;

/// Runs beside a Vibration, with its steps: one run for each thing that may be otherwise. Not linearised in the
/// frequency, whose error changes phases. While the vibration follows readings its own errors are known better: the
/// runs wait, and start from where it is. No allocation.
class VibrationSpread {
 public:
  static constexpr int kStiffer = 0, kSofter = 1, kDamped = 2, kLoads = 3, kMaxRuns = 7;

  explicit VibrationSpread(const OilDeviation& given = {}) : given_(given) {}

  /// After Vibration::setPose(): its modes and, where they are identified, how well.
  void follow(const Vibration& vibration) noexcept;
  /// Advances as Vibration::advance(); errors of the load at the step's end, linear from those at its begin.
  void advance(double step, const TorqueStep& torque, const LoadSpread& to) noexcept;
  void strike(const JointVector& impulse) noexcept;
  void rest() noexcept;
  /// At rest as far as is known; in truth each mode may swing so far, whatever its phase, and does so less and less.
  /// swing: standard deviations [m sqrt(kg)].
  void begin(const JointVector& swing) noexcept { swing_ = swing; }

  /// While the vibration follows readings: advance() does nothing.
  bool waits() const noexcept { return waits_; }
  /// Deviation of a mode: as given or, where that is less, as identified.
  const OilDeviation& deviation(int mode) const noexcept { return deviation_[static_cast<std::size_t>(mode)]; }
  int runs() const noexcept { return kLoads + static_cast<int>(load_.cols()); }
  /// By what the joints' accelerations of a run differ from those of the vibration, at the same instant [rad/s2].
  JointVector accelerationDifference(int run, const JointVector& vibration) const noexcept;
  /// Returns true if a vibration of unknown state was going on when it began to be followed.
  bool swings() const noexcept { return swing_.size() > 0; }
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
