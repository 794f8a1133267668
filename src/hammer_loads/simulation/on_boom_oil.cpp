// Forces that hold the joints: oil in two chambers per cylinder, leakage between them, joint clearance, seals.
#include <algorithm>
#include <cmath>

#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/simulation/oil_boom.h"

namespace hammer_loads::simulation {

double HammerOnBoom::oilOf(std::size_t cylinder) const {
  return boom_.bulk_modulus * machine_.on_boom.cylinder_oil[cylinder];
}

/// Returns the steady pressures. One chamber carries the steady load, the other has the preload.
HammerOnBoom::Chambers HammerOnBoom::heldChambers(std::size_t k, const State& held, double weight) const {
  const OilCylinder& c = boom_.cylinders[k];
  const double steady = -weight / c.arm(held.x()[static_cast<int>(k)]), preload = machine_.on_boom.pressures.preload;
  const double bore_push = std::max(steady, 0.0) + preload * (steady > 0.0 ? c.rod_area : c.bore_area);
  return {bore_push / c.bore_area, (bore_push - steady) / c.rod_area};
}

/// Returns the stiffness of the oil about the joints [N m/rad].
Eigen::Vector3d HammerOnBoom::stiffness(const State& held, const Eigen::Vector3d& weight) const {
  Eigen::Vector3d K;
  for (int j = 0; j < 3; ++j) {
    const auto k = static_cast<std::size_t>(j);
    const OilCylinder& c = boom_.cylinders[k];
    const double angle = held.x()[j], arm = c.arm(angle);
    double bore = oilOf(k), rod = bore;
    if (machine_.on_boom.air > 0.0) {
      const Chambers at = heldChambers(k, held, weight[j]);
      const ChamberOil oil(oilOf(k), machine_.on_boom.air);
      bore = oil.bulkModulus(at.bore), rod = oil.bulkModulus(at.rod);
    }
    K[j] = arm * arm * (bore * c.bore_area * c.boreShare(angle) + rod * c.rod_area * c.rodShare(angle));
  }
  return K;
}

/// Returns the pressures after an extension of the rod [m] and leakage of a volume from bore to rod side [m3].
HammerOnBoom::Chambers HammerOnBoom::chambersAt(std::size_t k, double way, double leaked, const Hold& hold) const {
  const OilCylinder& c = boom_.cylinders[k];
  const int j = static_cast<int>(k);
  const double angle = hold.state.x()[j];
  const Chambers held = heldChambers(k, hold.state, hold.weight[j]);
  const ChamberOil oil(oilOf(k), machine_.on_boom.air);
  const double lost = leaked / c.bore_area, won = leaked / c.rod_area;  // as displacements of the rod [m]
  return {oil.compressed(held.bore, -c.boreShare(angle) * (way + lost)),
          oil.compressed(held.rod, c.rodShare(angle) * (way + won))};
}

double HammerOnBoom::push(std::size_t k, const Chambers& at) const {
  return boom_.cylinders[k].bore_area * at.bore - boom_.cylinders[k].rod_area * at.rod;
}

/// Pins are loose against the direction of the steady push, so that no force is transmitted within their clearance.
HammerOnBoom::Chambers HammerOnBoom::chambers(std::size_t k, const State& s, const Hold& hold) const {
  const OilCylinder& c = boom_.cylinders[k];
  const int j = static_cast<int>(k);
  const double way = c.length(s.x()[j]) - c.length(hold.state.x()[j]), leaked = s.leaked()[j];
  const Chambers tight = chambersAt(k, way, leaked, hold);
  const double side = hold.weight[j] / c.arm(hold.state.x()[j]) > 0.0 ? -1.0 : 1.0;  // side of the steady push
  const double here = side * push(k, tight), play = side * machine_.on_boom.pin_play;
  if (!(here < 0.0) || play == 0.0) return tight;
  const double beyond = side * push(k, chambersAt(k, way - play, leaked, hold));
  const double taken_up = beyond < 0.0 ? 1.0 : here / (here - beyond);
  return chambersAt(k, way - taken_up * play, leaked, hold);
}

/// Returns the leakage from bore to rod side [m3/s] in excess of the steady one, which the operator compensates.
Eigen::Vector3d HammerOnBoom::leak(const State& s, const Hold& hold) const {
  Eigen::Vector3d flow = Eigen::Vector3d::Zero();
  if (machine_.on_boom.leak == 0.0) return flow;
  for (std::size_t k = 0; k < 3; ++k) {
    const int j = static_cast<int>(k);
    const Chambers now = chambers(k, s, hold), held = heldChambers(k, hold.state, hold.weight[j]);
    flow[j] = machine_.on_boom.leak * (now.bore - now.rod - held.bore + held.rod);
  }
  return flow;
}

/// Returns the torques BY the oil ON the joints [N m].
Eigen::Vector3d HammerOnBoom::oil(const State& s, const Hold& hold) const {
  const Coordinates off = s.x() - hold.state.x(), rate = s.v() - hold.state.v();
  const Eigen::Vector3d damped = damping_ * rate.head<3>();
  if (!machine_.on_boom.isPlain()) {
    Eigen::Vector3d torque;
    for (std::size_t k = 0; k < 3; ++k) {
      const int j = static_cast<int>(k);
      torque[j] = boom_.cylinders[k].arm(s.x()[j]) * push(k, chambers(k, s, hold)) - damped[j];
    }
    return torque;
  }
  return -hold.weight - hold.stiffness.cwiseProduct(off.head<3>()) - damped;
}

/// Returns the torques BY the cylinders' seals ON the joints at a torque of the oil [N m].
Eigen::Vector3d HammerOnBoom::seals(const State& s, const Eigen::Vector3d& oil) const {
  const SealSettings& seal = machine_.on_boom.seals;
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  if (!seal.rubs()) return torque;
  for (int k = 0; k < 3; ++k) {
    const OilCylinder& c = boom_.cylinders[static_cast<std::size_t>(k)];
    const double arm = c.arm(s.x()[k]), speed = arm * s.v()[k];
    const double force =
        seal.constant * SealSettings::kReliefPressure * c.bore_area + seal.friction * std::abs(oil[k] / arm);
    const double way = seal.presliding > 0.0 ? s.sheared()[k] / seal.presliding
                                             : seal.nearStandstill(speed) * std::tanh(speed / seal.smooth_speed);
    torque[k] = -arm * force * way;
  }
  return torque;
}

/// Returns the rate of the seals' displacement before they slide [m/s].
Eigen::Vector3d HammerOnBoom::shear(const State& s) const {
  const SealSettings& seal = machine_.on_boom.seals;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  if (!(seal.presliding > 0.0)) return rate;
  for (int k = 0; k < 3; ++k) {
    const double speed = boom_.cylinders[static_cast<std::size_t>(k)].arm(s.x()[k]) * s.v()[k];
    rate[k] = speed - std::abs(speed) * s.sheared()[k] / (seal.presliding * seal.nearStandstill(speed));
  }
  return rate;
}

Eigen::Vector3d HammerOnBoom::holding(const State& s, const Hold& hold) const {
  const Eigen::Vector3d by_oil = oil(s, hold);
  return by_oil + seals(s, by_oil);
}

/// Reads the pressures. Both chambers share the remaining force as they would under a displacement of the rod.
void HammerOnBoom::readCylinders(const Hold& hold, OnBoomSensors& s) const {
  const Eigen::Vector3d torque = oil(now_, hold);
  for (std::size_t k = 0; k < 3; ++k) {
    const int j = static_cast<int>(k);
    const OilCylinder& c = boom_.cylinders[k];
    const Chambers at =
        machine_.on_boom.isPlain() ? heldChambers(k, hold.state, hold.weight[j]) : chambers(k, now_, hold);
    const double rest = torque[j] / c.arm(now_.x()[j]) - push(k, at);
    const double bore_share = c.boreShare(hold.state.x()[j]), rod_share = c.rodShare(hold.state.x()[j]);
    const double way = rest / (c.bore_area * bore_share + c.rod_area * rod_share);
    s.bore_pressure[k] = at.bore + bore_share * way;
    s.rod_pressure[k] = at.rod - rod_share * way;
  }
}

}  // namespace hammer_loads::simulation
