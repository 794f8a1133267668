/// One blow's piece of the recording against the equation of motion: residuals and their derivatives.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "hammer_loads/calibration/blow_shot.h"
#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::calibration {

/// What all blows share. seen = zero + offset + sum over n of c_n sin(n offset) + s_n (cos(n offset) - 1): c_n + i s_n
/// is the eccentricity a_n e^(i phase_n).
constexpr int kGlobals = 8;
using Globals = Eigen::Matrix<double, kGlobals, 1>;
enum GlobalIndex : Eigen::Index { kZero, kSine1, kCosine1, kSine2, kCosine2, kLogInertia, kStiffness, kDrag };
/// Those from here on change the motion itself.
constexpr int kShaping = kGlobals - kLogInertia;

/// Deviations of what is measured, and of what the drive does.
struct Noise {
  double angle{};        ///< of a reading [rad]
  bool angle_known{};    ///< by the counts; else it is learned
  double timing{};       ///< of a stamp [s]
  double speed{};        ///< of a measured speed [rad/s]
  double torque_walk{};  ///< random walk of the net torque [N m/sqrt(s)]
  double torque{};       ///< of the net torque, before anything is known [N m]
};

struct SegmentModel {
  const Mechanism& mechanism;
  Level level;
};

/// Least squares of one segment at the present parameters, weighted.
struct NormalEquations {
  Eigen::Matrix<double, kLocals, kLocals> ll;  ///< locals, with the prior of the torque
  Eigen::Matrix<double, kLocals, kLocals> ll_data;
  Eigen::Matrix<double, kLocals, kGlobals> lg;
  Eigen::Matrix<double, kGlobals, kGlobals> gg;
  Locals l;  ///< right-hand sides
  Globals g;
  double cost{};  ///< robust, half the sum of squares
};

/// A reading's residual where the model stands.
struct ResidualAt {
  double offset{}, speed{};  ///< of the crank
  double angle{};            ///< seen less predicted [rad]
  double speed_error{};      ///< measured less predicted [rad/s]; NaN: not measured
};

class SegmentFit {
 public:
  /// A first guess of the locals from the readings around the blow.
  SegmentFit(const BlowSegment& segment, const Globals& globals);

  const Locals& locals() const noexcept { return locals_; }
  void setLocals(const Locals& locals) noexcept { locals_ = locals; }
  std::size_t size() const noexcept { return segment_->points.size(); }

  double cost(const SegmentModel& model, const Globals& globals, const Noise& noise) const;
  NormalEquations linearise(const SegmentModel& model, const Globals& globals, const Noise& noise) const;
  /// The same motion seen once more, with other noise.
  BlowSegment replica(const SegmentModel& model, const Globals& globals, const Noise& noise, double count,
                      std::mt19937_64& random) const;
  /// With the same parameters on another recording of it.
  SegmentFit onto(const BlowSegment& segment) const {
    SegmentFit other = *this;
    other.segment_ = &segment;
    return other;
  }
  std::vector<ResidualAt> residuals(const SegmentModel& model, const Globals& globals) const;

 private:
  /// Only the sides asked for; the other one's points stay.
  enum class Sides { kBoth, kBefore, kAfter };
  void run(const SegmentModel& model, const Globals& globals, const Locals& locals, Sides sides,
           std::vector<ShotPoint>& points) const;
  static Sides sidesOf(Eigen::Index local) noexcept;
  std::size_t beforeCount(const Locals& locals) const;

  const BlowSegment* segment_;
  Locals locals_;
  double node_step_{}, mean_speed_{};
};

/// Residual beyond which a sample counts less (Huber) [deviations].
constexpr double kHuber = 3.0;

}  // namespace hammer_loads::calibration
