/// A force with its moment, and its transformation to another point and other axes.
#pragma once

#include <Eigen/Geometry>

namespace hammer_loads {

/// X_QP: pose of frame P in frame Q; takes coordinates in P to coordinates in Q.
using Pose = Eigen::Isometry3d;

/// w_P: moment about the origin of frame P, axes of P. The users of a wrench state which body acts on which.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]
};

/// The part in the boom's plane: force x, z, moment y.
inline Eigen::Vector3d inPlane(const Wrench& w) noexcept { return {w.force.x(), w.force.z(), w.torque.y()}; }

/// Wrench of the load at the origin of Q: f_Q = R f_P, t_Q = R t_P + p x f_Q with X_QP = (R, p). Error below 1e-15 of
/// |t| + |p||f|. tf2 0.7.6's doTransform leaves out p x f.
inline Wrench shifted(const Pose& X_QP, const Wrench& w_P) noexcept {
  Wrench w_Q;
  w_Q.force.noalias() = X_QP.linear() * w_P.force;
  w_Q.torque.noalias() = X_QP.linear() * w_P.torque;
  w_Q.torque += X_QP.translation().cross(w_Q.force);
  return w_Q;
}

inline Wrench operator+(const Wrench& a, const Wrench& b) noexcept { return {a.force + b.force, a.torque + b.torque}; }

}  // namespace hammer_loads
