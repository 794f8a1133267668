/// A force with its moment, and how it reads at another point and in other axes.
#pragma once

#include <Eigen/Geometry>

namespace hammer_loads {

/// X_QP: pose of frame P in frame Q; takes coordinates in P to coordinates in Q.
using Pose = Eigen::Isometry3d;

/// w_P: moment about the origin of frame P, axes of P. Who acts on whom is said where a wrench is used.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]
};

/// The same load at the origin of Q: f_Q = R f_P, t_Q = R t_P + p x f_Q with X_QP = (R, p).
/// Error below 1e-15 of |t| + |p||f|. tf2 0.7.6's doTransform leaves out p x f.
inline Wrench shifted(const Pose& X_QP, const Wrench& w_P) noexcept {
  Wrench w_Q;
  w_Q.force.noalias() = X_QP.linear() * w_P.force;
  w_Q.torque.noalias() = X_QP.linear() * w_P.torque;
  w_Q.torque += X_QP.translation().cross(w_Q.force);
  return w_Q;
}

/// The shift as a matrix on (force, torque): [R 0; [p]x R  R].
inline Eigen::Matrix<double, 6, 6> shiftMatrix(const Pose& X_QP) noexcept {
  const Eigen::Matrix3d R = X_QP.linear();
  const Eigen::Vector3d p = X_QP.translation();
  Eigen::Matrix3d p_cross;
  p_cross << 0.0, -p.z(), p.y(), p.z(), 0.0, -p.x(), -p.y(), p.x(), 0.0;
  Eigen::Matrix<double, 6, 6> shift = Eigen::Matrix<double, 6, 6>::Zero();
  shift.topLeftCorner<3, 3>() = R;
  shift.bottomRightCorner<3, 3>() = R;
  shift.bottomLeftCorner<3, 3>() = p_cross * R;
  return shift;
}

}  // namespace hammer_loads
