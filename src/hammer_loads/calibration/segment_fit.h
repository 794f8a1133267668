/// One blow's piece of the recording against the equation of motion: residuals and their derivatives.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "hammer_loads/calibration/blow_shot.h"
#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::calibration {

/// Parameters that all blows share. seen = zero + offset + sum over n of c_n sin(n offset) + s_n (cos(n offset) - 1):
/// c_n + i s_n is the eccentricity a_n e^(i phase_n).
enum GlobalIndex : Eigen::Index { kZero, kSine1, kCosine1, kSine2, kCosine2, kLogInertia, kStiffness, kDrag, kGlobals };
using Globals = Eigen::Matrix<double, kGlobals, 1>;
/// Number of shared parameters, from kLogInertia on, that change the motion itself.
constexpr int kShaping = kGlobals - kLogInertia;

/// Deviations of what is measured, and of what the drive does.
struct Noise {
  double angle{};        ///< standard deviation of a reading [rad]
  bool angle_known{};    ///< by the counts; else it is learned
  double timing{};       ///< standard deviation of a stamp [s]
  double speed{};        ///< standard deviation of a measured speed [rad/s]
  double torque_walk{};  ///< random walk of the net torque [N m/sqrt(s)]
  double torque{};       ///< standard deviation of the net torque, before any reading [N m]
};

struct SegmentModel {
  SegmentModel(const Mechanism& of, Level with) : mechanism(of), level(with), shaft(of, with) {}
  const Mechanism& mechanism;
  Level level;
  ShaftModel shaft;  ///< shaft of the mechanism at this level, with the hull at rest
};

using LocalMatrix = Eigen::Matrix<double, kLocals, kLocals>;
using GlobalMatrix = Eigen::Matrix<double, kGlobals, kGlobals>;

/// Least squares of one segment at the present parameters, weighted.
struct NormalEquations {
  LocalMatrix ll_angles = LocalMatrix::Zero(), ll_speeds = LocalMatrix::Zero();  ///< information on the locals
  LocalMatrix ll;                                                                ///< both, with the torque's prior
  Eigen::Matrix<double, kLocals, kGlobals> lg = Eigen::Matrix<double, kLocals, kGlobals>::Zero();
  GlobalMatrix gg = GlobalMatrix::Zero();
  Locals l = Locals::Zero();  ///< right-hand sides
  Globals g = Globals::Zero();
};

/// Weights of a sample's residuals. An error of the stamp moves angle and speed together: `share` of the angle's
/// residual is subtracted from the speed's, after which they are independent.
struct Weighing {
  double angle{};  ///< deviation [rad]
  double speed{};  ///< standard deviation of the speed's residual after that [rad/s]
  double share{};  ///< [1/s]
};

/// A reading's residual where the model stands.
struct ResidualAt {
  double offset{}, speed{};  ///< offset and speed of the encoder
  double angle{};            ///< seen less predicted [rad]
  double speed_error{};      ///< measured less predicted, less its share of the angle's [rad/s]; NaN: not measured
  Weighing deviation;
};

/// A residual with its derivatives, negative: of what the model predicts.
struct ResidualRow {
  std::size_t point{};  ///< index of the point in the segment
  ShotPoint at;         ///< the encoder there
  bool of_speed{};
  double residual{}, deviation{};
  Locals by_local;
  Globals by_global;
  double by_offset{}, by_speed{};  ///< derivatives by the encoder's motion there
};

/// Weight of a row in the sum of squares: Huber's, over the variance.
double weightOf(const ResidualRow& row);

class SegmentFit {
 public:
  /// A first guess of the locals from the readings around the blow.
  SegmentFit(const BlowSegment& segment, const Globals& globals);

  const Locals& locals() const noexcept { return locals_; }
  void setLocals(const Locals& locals) noexcept { locals_ = locals; }
  std::size_t size() const noexcept { return segment_->points.size(); }

  double cost(const SegmentModel& model, const Globals& globals, const Noise& noise) const;
  NormalEquations linearise(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
    return equationsOf(rows(model, globals, noise), noise);
  }
  /// rows: of this segment.
  NormalEquations equationsOf(const std::vector<ResidualRow>& rows, const Noise& noise) const;
  std::vector<ResidualRow> rows(const SegmentModel& model, const Globals& globals, const Noise& noise) const;
  /// d(offset, speed)/d(locals, shaping globals).
  using MotionSlopes = Eigen::Matrix<double, 2, kLocals + kShaping>;
  /// The encoder at the segment's points, in their order, and its slopes where they are asked for. The model may be
  /// that of another hammer.
  std::vector<ShotPoint> motion(const SegmentModel& model, const Globals& globals,
                                std::vector<MotionSlopes>* slopes = nullptr) const;
  /// Replica of the segment: the fitted motion with new noise, read at instants that differ from their stamps.
  /// sign: of all errors; the mean of two replicas that differ in it alone has no error of first order.
  BlowSegment replica(const SegmentModel& model, const Globals& globals, const Noise& noise, double count, double sign,
                      std::mt19937_64& random) const;
  /// With the same parameters on another recording of it.
  SegmentFit onto(const BlowSegment& segment) const {
    SegmentFit other = *this;
    other.segment_ = &segment;
    return other;
  }
  std::vector<ResidualAt> residuals(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
    return residualsAt(motion(model, globals), globals, noise);
  }

 private:
  std::vector<ResidualAt> residualsAt(const std::vector<ShotPoint>& points, const Globals& globals,
                                      const Noise& noise) const;
  Weighing weighing(const Noise& noise, double time, const ShotPoint& at) const;
  HalfShot halfOf(const Globals& globals, bool before) const;
  std::size_t beforeCount() const;

  const BlowSegment* segment_;
  Locals locals_;
  double node_step_{}, mean_speed_{};
};

}  // namespace hammer_loads::calibration
