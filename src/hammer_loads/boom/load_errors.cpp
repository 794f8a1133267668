#include "hammer_loads/boom/load_errors.h"

#include "hammer_loads/util/known_count.h"

namespace hammer_loads {
namespace {

Eigen::Vector3d across(const Wrench& w) noexcept { return {w.force.y(), w.torque.x(), w.torque.z()}; }

}  // namespace

LoadErrors::LoadErrors(const std::vector<Cylinder>& cylinders) noexcept : held_(static_cast<int>(cylinders.size())) {
  covariance_.leftCols(held_ + 6).setZero();
  for (std::size_t i = 0; i < cylinders.size(); ++i) joint_[i] = cylinders[i].joint();
}

LoadErrors::Inputs LoadErrors::inputsOf(const JointVector& acceleration) const noexcept {
  Inputs inputs = Inputs::Zero();
  for (int i = 0; i < held_; ++i) inputs[i] = acceleration[joint_[static_cast<std::size_t>(i)]];
  return inputs;
}

void LoadErrors::setTip(const Wrench& tip, Inputs& inputs) noexcept {
  inputs.segment<3>(held_) = inPlane(tip), inputs.segment<3>(held_ + 3) = across(tip);
  across_ = across_ || !across(tip).isZero(0.0);
}

/// one other^T, symmetric in the sum of all that is added.
void LoadErrors::addProduct(const Inputs& one, const Inputs& other) noexcept {
  withCount<kUsualInputs>(size(), [&](auto end) {
    for (int c = 0; c < end; ++c) {
      for (int r = c; r < end; ++r) covariance_(r, c) += one[r] * other[c];
    }
  });
}

void LoadErrors::add(const JointVector& acceleration, const Wrench& tip) noexcept {
  Inputs inputs = inputsOf(acceleration);
  setTip(tip, inputs);
  addProduct(inputs, inputs);
}

void LoadErrors::addInPlane(const Eigen::Vector3d& tip) noexcept {
  for (int c = 0; c < 3; ++c) {
    for (int r = c; r < 3; ++r) covariance_(held_ + r, held_ + c) += tip[r] * tip[c];
  }
}

void LoadErrors::add(const BoomModes& modes, const JointMatrix& covariance,
                     const std::array<Eigen::Vector3d, kMaxJoints>& tip) noexcept {
  std::array<Inputs, kMaxJoints> by_mode;
  for (int k = 0; k < modes.count; ++k) {
    Inputs& inputs = by_mode[static_cast<std::size_t>(k)];
    for (int i = 0; i < held_; ++i) inputs[i] = modes.shape(i, k);
    inputs.segment<3>(held_) = tip[static_cast<std::size_t>(k)];
    inputs.segment<3>(held_ + 3).setZero();
  }
  for (int k = 0; k < modes.count; ++k) {
    Inputs with = Inputs::Zero();  // covariance of the inputs with mode k
    withCount<kUsualInputs>(size(), [&](auto end) {
      for (int l = 0; l < modes.count; ++l) {
        for (int r = 0; r < end; ++r) with[r] += covariance(l, k) * by_mode[static_cast<std::size_t>(l)][r];
      }
    });
    addProduct(with, by_mode[static_cast<std::size_t>(k)]);
  }
}

void LoadErrors::addLarger(const JointVector& acceleration, const JointVector& other) noexcept {
  larger_ = {inputsOf(acceleration), inputsOf(other)};
  has_larger_ = true;
}

void LoadErrors::findVariances(const Eigen::Ref<const Eigen::MatrixXd>& response,
                               Eigen::Ref<Eigen::VectorXd> variance) const noexcept {
  const Eigen::Index inputs = size();
  variance.setZero();
  for (Eigen::Index k = 0; k < inputs; ++k) {
    const Eigen::Index after = inputs - k - 1;
    const auto& column = covariance_.col(k);
    variance.array() +=
        response.col(k).array() *
        (column[k] * response.col(k) + 2.0 * response.rightCols(after).lazyProduct(column.segment(k + 1, after)))
            .array();
  }
  // Not cwiseMax(), which loses a not-a-number with Eigen 3.3.
  variance = (variance.array() < 0.0).select(0.0, variance);
  if (!has_larger_) return;
  const auto squares = [&](const Inputs& one) { return (response.lazyProduct(one.head(inputs))).cwiseAbs2(); };
  variance += squares(larger_[0]).cwiseMax(squares(larger_[1]));
}

}  // namespace hammer_loads
