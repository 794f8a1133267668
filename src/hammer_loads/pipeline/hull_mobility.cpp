#include "hammer_loads/pipeline/hull_mobility.h"

#include <Eigen/Cholesky>

namespace hammer_loads {

HullMobility::HullMobility(const Boom& boom, const Eigen::Vector3d& position)
    : chain_(boom.chain()),
      dynamics_(chain_),
      unit_(position),
      refresh_angle_(boom.parameters().vibration.refresh_angle) {
  for (const Cylinder& cylinder : boom.cylinders()) joints_.push_back(cylinder.joint());
}

std::optional<HullMobility::Mobility> HullMobility::movedTo(const JointVector& position) noexcept {
  const auto n = static_cast<int>(joints_.size());
  if (n == 0) return std::nullopt;
  if (at_.size() > 0 && (position - at_).cwiseAbs().maxCoeff() <= refresh_angle_) return std::nullopt;
  at_ = position;
  forwardKinematics(chain_, position, pose_);
  const Jacobian tip = tipJacobian(pose_);
  const JointMatrix all = dynamics_.massMatrix(position);
  JointMatrix M(n, n);
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxJoints> of_d(3, n);
  for (int i = 0; i < n; ++i) {
    const int joint = joints_[static_cast<std::size_t>(i)];
    of_d.col(i) << tip(0, joint), tip(2, joint), tip(4, joint);
    for (int k = 0; k < n; ++k) M(i, k) = all(joint, joints_[static_cast<std::size_t>(k)]);
  }
  auto of_unit = of_d;
  of_unit.row(0) += unit_.z() * of_d.row(2), of_unit.row(1) -= unit_.x() * of_d.row(2);
  const Eigen::LLT<JointMatrix> factor(M);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const auto mobility = [&](const auto& of, const auto& by) {
    return Eigen::Matrix3d(of * factor.solve(by.transpose()));
  };
  // No entry of a positive definite matrix exceeds the geometric mean of the two diagonal entries.
  const Eigen::Vector3d rows = mobility(of_unit, of_unit).diagonal().cwiseSqrt();
  const Eigen::Vector3d columns = mobility(of_d, of_d).diagonal().cwiseSqrt();
  const Mobility result{mobility(of_unit, of_d), rows * columns.transpose()};
  if (!result.value.allFinite() || !result.most.allFinite()) return std::nullopt;
  return result;
}

}  // namespace hammer_loads
