#include "hammer_loads/boom/contact_load.h"

#include "hammer_loads/util/square.h"

namespace hammer_loads {

InPlaneTip::InPlaneTip(const Jacobian& J, const std::array<int, 3>& joints) noexcept : joints_(joints) {
  // The torque on each joint by (force x, force z, moment y).
  const auto row = [&](std::size_t i) {
    const int joint = joints[i];
    return Eigen::Vector3d(J(0, joint), J(2, joint), J(4, joint));
  };
  const Eigen::Vector3d a = row(0), b = row(1), c = row(2), bc = b.cross(c);
  const double determinant = a.dot(bc);
  const Eigen::Array3d size = a.array().square() + b.array().square() + c.array().square();
  known_ = square(determinant) > square(1e-3) * size.prod();
  inverse_ << bc, c.cross(a), a.cross(b);
  inverse_ *= 1.0 / determinant;
}

}  // namespace hammer_loads
