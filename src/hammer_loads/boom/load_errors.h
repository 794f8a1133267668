/// Errors of what acts on the boom as one covariance, and the error of a boom that is taken as rigid.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/boom_modes.h"
#include "hammer_loads/boom/wrench.h"

namespace hammer_loads {

/// Errors of the accelerations of the cylinders' joints [rad/s2] and of the load on the tip, axes of the tip [N, N m].
/// No allocation.
class LoadErrors {
 public:
  static constexpr int kMost = kMaxJoints + 6;
  /// Quantities in error: accelerations in the order of the cylinders, then the part of the load in the boom's plane
  /// (force x, z, moment y), then the part across it (force y, moment x, z).
  using Inputs = Eigen::Matrix<double, kMost, 1>;

  explicit LoadErrors(const std::vector<Cylinder>& cylinders) noexcept;

  /// One error that is independent of the others, one standard deviation of it; acceleration: of all joints.
  void add(const JointVector& acceleration, const Wrench& tip) noexcept;
  /// Adds an error of the load alone, in the boom's plane: force x, z, moment y.
  void addInPlane(const Eigen::Vector3d& tip) noexcept;
  /// Errors of the modes' accelerations, covariance [m2 kg/s4]; tip: of the load in the plane with one unit of each
  /// mode's.
  void add(const BoomModes& modes, const JointMatrix& covariance,
           const std::array<Eigen::Vector3d, kMaxJoints>& tip) noexcept;
  /// Adds two errors that exclude each other, one standard deviation each; for each load the larger counts.
  void addLarger(const JointVector& acceleration, const JointVector& other) noexcept;

  int size() const noexcept { return isAcross() ? held_ + 6 : held_ + 3; }  ///< number of inputs in use
  bool isAcross() const noexcept { return across_; }                        ///< some of the load lies across the plane
  /// Finds the variances of loads that are linear in the inputs, one a row of response; its columns are the inputs in
  /// use. A variance that rounding would make negative is zero.
  void findVariances(const Eigen::Ref<const Eigen::MatrixXd>& response,
                     Eigen::Ref<Eigen::VectorXd> variance) const noexcept;

 private:
  Inputs inputsOf(const JointVector& acceleration) const noexcept;
  void setTip(const Wrench& tip, Inputs& inputs) noexcept;
  void addProduct(const Inputs& one, const Inputs& other) noexcept;

  static constexpr int kUsualInputs = 6;  ///< compiled for: three cylinders and a load in the boom's plane

  int held_{};  ///< by cylinders
  std::array<int, kMaxJoints> joint_{};
  bool across_{}, has_larger_{};
  /// Covariance of the inputs in use; only the lower triangle with the diagonal counts.
  Eigen::Matrix<double, kMost, kMost> covariance_;
  std::array<Inputs, 2> larger_;
};

/// Largest difference between the joint torques that the vibrating boom holds and the static ones, J^T w, over the
/// largest of the latter [-], for one half-sine pulse of that peak (joint torques [N m]) and length [s] on a boom at
/// rest. Small when the pulse is long against the longest period; about 1 when it is short: then impulse times natural
/// frequency, not the peak, is what the joints hold. Sampled, good to 1 %. 0 without modes or torque,
/// infinity for one that is not finite.
/// Neglects: vibration by earlier pulses (blow rate near a natural frequency).
double rigidError(const BoomModes& modes, double damping_ratio, const JointVector& peak_torque,
                  double pulse_length) noexcept;

}  // namespace hammer_loads
