#include "hammer_loads/boom/contact_load.h"

#include <Eigen/LU>

#include "hammer_loads/util/square.h"

namespace hammer_loads {

std::optional<InPlaneTip> InPlaneTip::make(const Jacobian& J, const std::array<int, 3>& joints) noexcept {
  Eigen::Matrix3d rows;  // torque = rows . (force x, force z, moment y)
  for (int i = 0; i < 3; ++i) {
    const int joint = joints[static_cast<std::size_t>(i)];
    rows.row(i) << J(0, joint), J(2, joint), J(4, joint);
  }
  const double size_square = rows.col(0).squaredNorm() * rows.col(1).squaredNorm() * rows.col(2).squaredNorm();
  if (!(square(rows.determinant()) > square(1e-3) * size_square)) return std::nullopt;
  InPlaneTip tip;
  tip.joints_ = joints;
  tip.inverse_ = rows.inverse();
  return tip;
}

}  // namespace hammer_loads
