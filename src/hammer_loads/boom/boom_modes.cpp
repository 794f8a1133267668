#include "hammer_loads/boom/boom_modes.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "hammer_loads/util/known_count.h"

namespace hammer_loads {
namespace {

void clear(BoomModes& modes) noexcept {
  modes.count = 0;
  modes.omega.resize(0), modes.given_omega.resize(0);
  modes.oil_share.resize(0, 0), modes.shape.resize(0, 0), modes.inertia.resize(modes.mass.rows(), 0);
}

}  // namespace

void findModes(MassMatrix& mass, const std::vector<Cylinder>& cylinders, const JointVector& position,
               const Eigen::Vector3d& g_B, const LogOil& oil, BoomModes& modes) noexcept {
  modes.count = static_cast<int>(cylinders.size());
  modes.zero_moment_arm = false;
  modes.mass = mass.at(position);
  modes.stiffness.resize(modes.count);
  for (int i = 0; i < modes.count; ++i) {
    const Cylinder& cylinder = cylinders[static_cast<std::size_t>(i)];
    const CylinderPosition at = cylinder.at(position[cylinder.joint()]);
    modes.joint[static_cast<std::size_t>(i)] = cylinder.joint();
    modes.stiffness[i] = std::exp(oil[i]) * cylinder.jointStiffness(at);
    modes.zero_moment_arm = modes.zero_moment_arm || at.zero_moment_arm;
  }
  if (modes.zero_moment_arm) modes.count = 0;
  const int n = modes.count;
  if (n == 0) {
    clear(modes);
    return;
  }
  JointMatrix M(n, n), columns(modes.mass.rows(), n);
  for (int i = 0; i < n; ++i) columns.col(i) = modes.mass.col(modes.joint[static_cast<std::size_t>(i)]);
  for (int i = 0; i < n; ++i) M.row(i) = columns.row(modes.joint[static_cast<std::size_t>(i)]);
  // The cylinders' K gives K^-1/2 M K^-1/2 y = (1 + weight's share) y/omega^2. It is well conditioned, as every K is
  // positive.
  const JointVector soft = modes.stiffness.cwiseSqrt().cwiseInverse();
  const JointMatrix by_weight = weightStiffness(mass.chain(), position, g_B);
  JointMatrix scaled = M, stiff = JointMatrix::Identity(n, n);
  for (int j = 0; j < n; ++j) {
    scaled.col(j).array() *= soft.array() * soft[j];
    for (int i = 0; i < n; ++i)
      stiff(i, j) += soft[i] * soft[j] *
                     by_weight(modes.joint[static_cast<std::size_t>(i)], modes.joint[static_cast<std::size_t>(j)]);
  }
  if (stiff.llt().info() != Eigen::Success) stiff.setIdentity();  // no boom has oil too soft for its weight
  Eigen::GeneralizedSelfAdjointEigenSolver<JointMatrix> solver(n);
  solver.compute(scaled, stiff);
  // Rounding makes a zero inertia about some axis slightly positive or negative.
  if (!(solver.eigenvalues()[0] > 1e-14 * solver.eigenvalues()[n - 1])) {
    clear(modes);
    return;
  }
  modes.omega.resize(n), modes.oil_share.resize(n, n), modes.shape.resize(n, n);
  for (int k = 0; k < n; ++k) {
    const double inverse_square = solver.eigenvalues()[n - 1 - k];  // lowest frequency first
    modes.omega[k] = 1.0 / std::sqrt(inverse_square);
    modes.shape.col(k) = solver.eigenvectors().col(n - 1 - k).cwiseProduct(soft) * modes.omega[k];
    modes.oil_share.col(k) = modes.shape.col(k).cwiseAbs2().cwiseProduct(modes.stiffness) * inverse_square;
  }
  modes.given_omega = modes.omega;
  modes.inertia.noalias() = columns * modes.shape;
}

JointVector modalForce(const BoomModes& modes, const JointVector& joint_torque) noexcept {
  JointVector force(modes.count);
  withCount<3>(modes.count, [&](auto count) {
    for (int k = 0; k < count; ++k) {
      double sum = 0.0;
      for (int i = 0; i < count; ++i) sum += joint_torque[modes.joint[static_cast<std::size_t>(i)]] * modes.shape(i, k);
      force[k] = sum;
    }
  });
  return force;
}

TorqueStep modalForces(const BoomModes& modes, const TorqueStep& joint_torque) noexcept {
  return {modalForce(modes, joint_torque.from), modalForce(modes, joint_torque.to),
          modalForce(modes, joint_torque.mean)};
}

JointVector jointsOf(const BoomModes& modes, const JointVector& modal) noexcept {
  JointVector joints = JointVector::Zero(modes.mass.rows());
  withCount<3>(modes.count, [&](auto count) {
    for (int i = 0; i < count; ++i) {
      double sum = modes.shape(i, 0) * modal[0];
      for (int k = 1; k < count; ++k) sum += modes.shape(i, k) * modal[k];
      joints[modes.joint[static_cast<std::size_t>(i)]] = sum;
    }
  });
  return joints;
}

JointVector modalOf(const BoomModes& modes, const JointVector& joints) noexcept {
  JointVector modal = JointVector::Zero(modes.count);
  for (int i = 0; i < modes.count; ++i) {
    const int joint = modes.joint[static_cast<std::size_t>(i)];
    modal += joints[joint] * modes.inertia.row(joint).transpose();
  }
  return modal;
}

VibrationReading tipRateReading(const Jacobian& J, const Eigen::Vector3d& n_T, double rate) {
  VibrationReading reading;
  reading.value = rate;
  for (Eigen::Index j = 0; j < J.cols(); ++j) reading.velocity[j] = n_T.dot(J.col(j).tail<3>());
  return reading;
}

VibrationReading tipAccelerationReading(const Jacobian& J, const Eigen::Vector3d& p_T, const Eigen::Vector3d& n_T,
                                        const Eigen::Vector3d& g_T, double acceleration) {
  VibrationReading reading;
  reading.value = acceleration + n_T.dot(g_T);
  // Terms n . (v + omega x p) and n . (omega x g). The second is due to gravity, as the vibration tilts the sensor.
  const Eigen::Vector3d p_n = p_T.cross(n_T), g_n = g_T.cross(n_T);
  for (Eigen::Index j = 0; j < J.cols(); ++j) {
    const auto omega = J.col(j).tail<3>();
    reading.acceleration[j] = n_T.dot(J.col(j).head<3>()) + omega.dot(p_n);
    reading.displacement[j] = omega.dot(g_n);
  }
  return reading;
}

VibrationReading jointAngleReading(int joint, double angle) {
  VibrationReading reading;
  reading.value = angle;
  reading.displacement[joint] = 1.0;
  return reading;
}

VibrationReading oilTorqueReading(int joint, double torque) {
  VibrationReading reading;
  reading.of_oil = true;
  reading.oil[joint] = 1.0;
  reading.value = torque;
  return reading;
}

}  // namespace hammer_loads
