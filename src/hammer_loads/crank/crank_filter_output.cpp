// What the filter is given beside readings, the hull and a rod; and what it gives: its estimate at a sample and between
// the last two, with deviations.
#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/crank/flexible_belief.h"
#include "hammer_loads/estimation/gates.h"

namespace hammer_loads {

Eigen::Matrix3d CrankUncertainty::covariance() const noexcept {
  return own + by_constant.topRows<3>() * by_constant.topRows<3>().transpose();
}

void CrankFilter::setHullMotion(const HullMotion& hull) noexcept {
  model_.setHullMotion(hull);
  hull_moved_ = true;
}

/// Of now_, with the latest motion of the hull.
void CrankFilter::takeLoad() noexcept {
  load_ = model_(now_.state.position.angle);
  now_hull_ = model_.hullMotion();
  hull_moved_ = false;
}

/// Where the ring would throw the filter off, which knows of no rod; smaller ones it smooths. A reading that it then
/// follows is as good a sign of a rod as one that contradicts it.
void CrankFilter::considerRod(double angle, double speed) noexcept {
  double& of_speed = now_.covariance(CrankBelief::kSpeed, CrankBelief::kSpeed);
  if (!exceeds(speed, of_speed, gate::kImpossible)) return;
  rod_evidence_.add(now_.state.position.angle, square(speed) / of_speed);
  of_speed += square(speed);
  now_.covariance(CrankBelief::kAngle, CrankBelief::kAngle) += square(angle);
  rod_ = {angle, speed};
}

/// An innovation as if no rod had been considered: what a rigid mechanism expects of the reading.
Innovation CrankFilter::withoutRod(double dt, Innovation innovation) const noexcept {
  innovation.total = std::max(innovation.variance, innovation.total - square(rod_.angle) - square(dt * rod_.speed));
  return innovation;
}

BlowFactor CrankFilter::blowFactor() const noexcept {
  return now_.blowFactor(model_, consistency_.doubt(), errors_.root());
}

bool CrankFilter::isPlausible() const noexcept { return std::abs(now_.state.torque) <= mostTorque(); }

CrankEstimate CrankFilter::between(double dt) const noexcept {
  if (dt >= step_) return estimate();
  if (dt == 0.0) return estimateOf(model_, before_load_, before().state);
  return estimateBetween(lastStep(), dt);
}

std::optional<CrankWays> CrankFilter::waysBetween(double dt) const noexcept {
  return hammer_loads::waysBetween(lastStep(), std::min(dt, step_));
}

/// The way forward from the sample before may strike earlier than the way between both, with a blow not yet known.
CrankUncertainty CrankFilter::uncertaintyBetween(double dt, double torque_part) const noexcept {
  if (dt >= step_) return uncertainty(torque_part);
  CrankBelief belief = before();
  const bool comes_to_blow =
      before().state.position.angle.side == Side::kBeforeBlow && isNearTool(before().state, step_);
  const bool is_before = comes_to_blow && between(dt).position.angle.side == Side::kBeforeBlow;
  predict(dt, !is_before, belief);
  return uncertaintyOf(belief, model_(belief.state.position.angle), torque_part);
}

CrankUncertainty CrankFilter::uncertaintyOf(const CrankBelief& belief, const ShaftLoad& load,
                                            double torque_part) const noexcept {
  const double part = std::min(1.0, torque_part * roughness_.deviationFactor());
  const double doubt = consistency_.doubt();
  return belief.motor ? flexibleUncertainty(model_, belief, doubt, errors_.root(), part)
                      : motionUncertainty(model_, load, belief, doubt, errors_.root(), part);
}

}  // namespace hammer_loads
