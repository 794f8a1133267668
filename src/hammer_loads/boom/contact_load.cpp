#include "hammer_loads/boom/contact_load.h"

#include <Eigen/LU>
#include <cmath>

namespace hammer_loads {

std::optional<Wrench> inPlaneTipLoad(const ChainPose& pose, const std::array<int, 3>& joints,
                                     const Eigen::Vector3d& torque) noexcept {
  const Jacobian J = tipJacobian(pose);
  Eigen::Matrix3d rows;  // torque = rows . (force x, force z, moment y)
  for (int i = 0; i < 3; ++i) {
    const int joint = joints[static_cast<std::size_t>(i)];
    rows.row(i) << J(0, joint), J(2, joint), J(4, joint);
  }
  const double size = rows.col(0).norm() * rows.col(1).norm() * rows.col(2).norm();
  if (!(std::abs(rows.determinant()) > 1e-3 * size)) return std::nullopt;
  const Eigen::Vector3d load = rows.inverse() * torque;
  return Wrench{{load[0], 0.0, load[1]}, {0.0, load[2], 0.0}};
}

}  // namespace hammer_loads
