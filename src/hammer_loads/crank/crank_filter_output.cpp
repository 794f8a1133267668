// What the filter gives: its estimate at a sample and between the last two, with deviations.
#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/flexible_belief.h"

namespace hammer_loads {

void CrankFilter::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  hull_moved_ = true;
}

BlowFactor CrankFilter::blowFactor() const noexcept {
  const ConstantErrors::Matrix& moment = errors_.moment();
  BlowFactor factor = now_.blowFactor(now_.grown(growth(), moment));
  if (!now_.motor) return factor;
  const double share = 1.0 - struckInertia() / driveInertia();
  factor.drive_inertia = struckInertia();
  factor.inertia_deviation =
      std::hypot(factor.inertia_deviation, share * std::sqrt(moment(ConstantErrors::kShare, ConstantErrors::kShare)));
  return factor;
}

double CrankFilter::struckInertia() const noexcept {
  return now_.motor ? lawOf(*model_.coupling(), now_.state).crank_inertia : driveInertia();
}

bool CrankFilter::isPlausible() const noexcept { return std::abs(now_.state.torque) <= mostTorque(); }

CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  if (dt == 0.0) return estimateOf(model_, before_load_, before_.state);
  return estimateBetween(lastStep(), dt);
}

std::optional<CrankWays> CrankFilter::waysBetween(double dt) const noexcept {
  return hammer_loads::waysBetween(lastStep(), std::min(dt, step_));
}

/// The way forward from the sample before may strike earlier than the way between both, with a blow not yet known.
Eigen::Matrix3d CrankFilter::covarianceBetween(double dt, double torque_part) const noexcept {
  if (dt >= step_) return motionCovariance(torque_part);
  CrankBelief belief = before_;
  const bool comes_to_blow = before_.state.position.angle.side == Side::kBeforeBlow && isNearTool(before_.state, step_);
  const bool is_before = comes_to_blow && between(dt).position.angle.side == Side::kBeforeBlow;
  predict(dt, !is_before, belief);
  return covarianceOf(belief, model_(belief.state.position.angle), torque_part);
}

Eigen::Matrix3d CrankFilter::covarianceOf(const CrankBelief& belief, const ShaftLoad& load,
                                          double torque_part) const noexcept {
  const double part = std::min(1.0, torque_part * roughness_.deviationFactor());
  return belief.motor
             ? flexibleMotionCovariance(model_, belief, consistency_.growth(), errors_.moment(), part)
             : hammer_loads::motionCovariance(model_, load, belief, consistency_.growth(), errors_.moment(), part);
}

}  // namespace hammer_loads
