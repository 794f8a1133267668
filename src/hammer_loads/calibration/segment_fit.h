/// Residuals of one blow's segment of the recording against the equation of motion, and their derivatives.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "hammer_loads/calibration/blow_shot.h"
#include "hammer_loads/calibration/crank_recording.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads::calibration {

/// Parameters shared by all blows. seen = zero + offset + sum over n of c_n sin(n offset) + s_n (cos(n offset) - 1):
/// c_n + i s_n is the eccentricity a_n e^(i phase_n).
enum GlobalIndex : Eigen::Index { kZero, kSine1, kCosine1, kSine2, kCosine2, kLogInertia, kStiffness, kDrag, kGlobals };
using Globals = Eigen::Matrix<double, kGlobals, 1>;
/// Number of shared parameters, from kLogInertia on, that change the motion itself.
constexpr int kShaping = kGlobals - kLogInertia;

/// Noise of the measurements and of the drive torque.
struct Noise {
  double angle{};        ///< standard deviation of a reading [rad]
  bool angle_known{};    ///< true if the counts determine it; otherwise it is estimated
  double timing{};       ///< standard deviation of a stamp [s]
  double speed{};        ///< standard deviation of a measured speed [rad/s]
  double torque_walk{};  ///< random walk of the net torque [N m/sqrt(s)]
  double torque{};       ///< prior standard deviation of the net torque [N m]
};

struct SegmentModel {
  SegmentModel(const Mechanism& of, Level with) : mechanism(of), level(with), shaft(of, with) {}
  const Mechanism& mechanism;
  Level level;
  ShaftModel shaft;  ///< shaft of the mechanism at this level, with the hull at rest
};

using LocalMatrix = Eigen::Matrix<double, kLocals, kLocals>;
using GlobalMatrix = Eigen::Matrix<double, kGlobals, kGlobals>;

/// Weighted normal equations of one segment at the current parameters.
struct NormalEquations {
  LocalMatrix ll_angles = LocalMatrix::Zero(), ll_speeds = LocalMatrix::Zero();  ///< information on the locals
  LocalMatrix ll;                                                                ///< sum of both and the torque's prior
  Eigen::Matrix<double, kLocals, kGlobals> lg = Eigen::Matrix<double, kLocals, kGlobals>::Zero();
  GlobalMatrix gg = GlobalMatrix::Zero();
  Locals l = Locals::Zero();  ///< right-hand sides
  Globals g = Globals::Zero();
};

/// Weights of a sample's residuals. A timing error changes angle and speed together. Subtracting `share` of the angle's
/// residual from the speed's makes the two independent.
struct Weighing {
  double angle{};  ///< standard deviation [rad]
  double speed{};  ///< standard deviation of the speed's residual after the subtraction [rad/s]
  double share{};  ///< [1/s]
};

/// Residuals of a sample at the state of the model.
struct ResidualAt {
  double offset{}, speed{};  ///< predicted offset and speed of the crank
  double angle{};            ///< reading minus prediction [rad]
  double speed_error{};      ///< measured minus predicted, minus its share of the angle's [rad/s]; NaN: not measured
  Weighing deviation;
};

/// Residual with its negative derivatives, which are those of the model's prediction.
struct ResidualRow {
  std::size_t point{};  ///< index of the point in the segment
  ShotPoint at;         ///< predicted motion of the crank at that point
  bool of_speed{};
  double residual{}, deviation{};
  Locals by_local;
  Globals by_global;
  double by_offset{}, by_speed{};  ///< derivatives by the crank's offset and speed
};

/// Returns the weight of a row in the sum of squares: Huber's weight over the variance.
double weightOf(const ResidualRow& row);

class SegmentFit {
 public:
  /// Sets a first guess of the locals from the readings around the blow.
  SegmentFit(const BlowSegment& segment, const Globals& globals);

  const Locals& locals() const noexcept { return locals_; }
  void setLocals(const Locals& locals) noexcept { locals_ = locals; }
  std::size_t size() const noexcept { return segment_->points.size(); }

  double cost(const SegmentModel& model, const Globals& globals, const Noise& noise) const;
  NormalEquations linearise(const SegmentModel& model, const Globals& globals, const Noise& noise) const {
    return equationsOf(rows(model, globals, noise), noise);
  }
  /// rows: rows of this segment.
  NormalEquations equationsOf(const std::vector<ResidualRow>& rows, const Noise& noise) const;
  std::vector<ResidualRow> rows(const SegmentModel& model, const Globals& globals, const Noise& noise) const;
  /// Derivatives of offset and speed by the locals and the shaping globals.
  using MotionSlopes = Eigen::Matrix<double, 2, kLocals + kShaping>;
  /// Returns the crank's motion at the segment's points, in their order, and its derivatives if requested. The model
  /// may be that of another hammer.
  std::vector<ShotPoint> motion(const SegmentModel& model, const Globals& globals,
                                std::vector<MotionSlopes>* slopes = nullptr) const;
  /// Returns a replica of the segment: the fitted motion with new noise, read at instants that differ from their
  /// stamps. sign: sign of all errors; the mean of two replicas with opposite signs has no error of first order.
  BlowSegment replica(const SegmentModel& model, const Globals& globals, const Noise& noise, double count, double sign,
                      std::mt19937_64& random) const;
  /// Returns a fit with the same parameters to another recording of the segment.
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
