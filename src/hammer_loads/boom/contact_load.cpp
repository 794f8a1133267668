#include "hammer_loads/boom/contact_load.h"

#include <Eigen/LU>
#include <cmath>

namespace hammer_loads {

std::optional<InPlaneTip> InPlaneTip::make(const Jacobian& J, const std::array<int, 3>& joints) noexcept {
  Eigen::Matrix3d rows;  // torque = rows . (force x, force z, moment y)
  for (int i = 0; i < 3; ++i) {
    const int joint = joints[static_cast<std::size_t>(i)];
    rows.row(i) << J(0, joint), J(2, joint), J(4, joint);
  }
  const double size = rows.col(0).norm() * rows.col(1).norm() * rows.col(2).norm();
  if (!(std::abs(rows.determinant()) > 1e-3 * size)) return std::nullopt;
  InPlaneTip tip;
  tip.joints_ = joints;
  tip.inverse_ = rows.inverse();
  return tip;
}

}  // namespace hammer_loads
