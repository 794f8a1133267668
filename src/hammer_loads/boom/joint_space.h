/// Quantities per joint of a chain, without heap allocation. Sizes vary up to a fixed maximum.
#pragma once

#include <Eigen/Core>

namespace hammer_loads {

constexpr int kMaxJoints = 8;  ///< moving joints of a chain
constexpr int kMaxLinks = 16;  ///< links of a chain, its root included

/// One entry per moving joint, from the root to the tip. A copy of the usual sizes takes a few instructions, while
/// Eigen would call memmove some forty times a sample.
class JointVector : public Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1> {
 public:
  using Base = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;
  using Base::Base;
  JointVector() = default;
  JointVector(const JointVector& other) noexcept : Base() { copy(other); }
  JointVector& operator=(const JointVector& other) noexcept {
    copy(other);
    return *this;
  }
  template <typename Other>
  JointVector(const Eigen::MatrixBase<Other>& other) : Base(other) {}
  template <typename Other>
  JointVector& operator=(const Eigen::MatrixBase<Other>& other) {
    Base::operator=(other);
    return *this;
  }

 private:
  void copy(const JointVector& other) noexcept {
    resize(other.size());
    if (other.size() == 4)
      head<4>() = other.head<4>();
    else if (other.size() == 3)
      head<3>() = other.head<3>();
    else
      Base::operator=(other);
  }
};
using JointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, kMaxJoints>;
/// Rows: linear velocity, angular velocity; one column per joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;

/// Motion of the chain's joints; revolute ones in [rad], prismatic ones in [m].
struct JointMotion {
  JointVector position;
  JointVector velocity;      ///< [1/s]
  JointVector acceleration;  ///< [1/s2]; zero where it is not known
};

}  // namespace hammer_loads
