/// Hull wrench at any level of the model by one function, with the reaction of the drive and the derivatives by the
/// hammer's constants.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/linkage/machine_columns.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads {

/// Half-sine pulse of the machine's nominal revolution: constant speed, without weight. Fz is then proportional to w^2,
/// with a shape that depends on the crank angle alone. P0 (15), (16) with time times w as angle.
struct NominalPulse {
  double amplitude{};  ///< H/w^2 [kg m]
  double frequency{};  ///< mu/w [-], half-sine periods per half turn
  double length{};     ///< pi w/mu: crank angle from its start to the blow [rad]
};

/// Mechanism with a level of the model; refers to the mechanism, which must outlive it.
class HullModel {
 public:
  /// Level pulse computes the nominal revolution at level rocker (some 0.2 ms); level elastic counts as linkage here.
  HullModel(const Mechanism& mechanism, Level level);

  const Mechanism& mechanism() const noexcept { return *mechanism_; }
  Level level() const noexcept { return level_; }
  const NominalPulse& nominalPulse() const noexcept { return pulse_; }  ///< zero except at level pulse

 private:
  const Mechanism* mechanism_;
  Level level_;
  NominalPulse pulse_;
};

/// Crank angle with the motion of the links there.
struct LinksAtAngle {
  CrankAngle angle;
  LinkMotion links;
};
inline LinksAtAngle linksAt(const HullModel& model, CrankAngle angle) noexcept {
  return {angle, linkMotion(model.mechanism().linkage(), angle)};
}

/// Crank angle left until the next forward blow [rad], exact near it.
inline double angleToBlow(CrankAngle angle) noexcept {
  return angle.side == Side::kBeforeBlow ? -angle.offset : kTwoPi - angle.offset;
}

/// Level pulse: half-sine in crank angle, amplitude in proportion to w^2, and the rocker's weight along the tool.
/// Neglects: Fx and the moment; crank acceleration; Fz before the last lobe (MO-100: -3 % of H) and the lobe's skewness
/// (MO-100: 6 % of H rms over the turn); turning of the hull. Keeps H and the impulse Q of the last lobe at constant
/// speed exactly. At work (MO-100, blows of 1000 J): Fx 33 %, Fz 24 %, moment 19 % of the peak off, rms (model.md 3).
inline HullWrench hullWrenchPulse(const Mechanism& mechanism, const NominalPulse& pulse, const CrankMotion& crank,
                                  Gravity gravity) noexcept {
  const double left = angleToBlow(crank.angle);
  const double sine = left < pulse.length ? std::sin(pulse.frequency * left) : 0.0;
  const double weight = mechanism.parameters().rocker_mass * gravity.z;
  return {0.0, pulse.amplitude * crank.speed * crank.speed * sine + weight, 0.0};
}

/// Minus the half-sine's impulse since the turn's start [N s] at constant speed, so that momentum differences give it.
inline LinkMomentum linkMomentumPulse(const NominalPulse& pulse, CrankAngle angle, double speed) noexcept {
  const double left = angleToBlow(angle);
  if (!(left < pulse.length)) return {};
  return {0.0, -pulse.amplitude * speed / pulse.frequency * (1.0 + std::cos(pulse.frequency * left)), 0.0};
}

/// Hull wrench at the model's level. No allocation, no failure for finite input.
HAMMER_LOADS_INLINE HullWrench hullWrench(const HullModel& model, const CrankMotion& crank,
                                          const HullMotion& hull) noexcept {
  if (model.level() != Level::kPulse) return hullWrench(model.mechanism(), model.level(), crank, hull);
  return hullWrenchPulse(model.mechanism(), model.nominalPulse(), crank, hull.gravity);
}

/// Wrench on the hull from the motion of the links at crank.angle, which the caller has computed.
inline HullWrench hullWrench(const HullModel& model, const LinkMotion& links, const CrankMotion& crank,
                             const HullMotion& hull) noexcept {
  if (model.level() == Level::kPulse)
    return hullWrenchPulse(model.mechanism(), model.nominalPulse(), crank, hull.gravity);
  if (model.level() == Level::kLinkage) return hullWrench(model.mechanism(), links, crank, hull);
  return hullWrench(model.mechanism(), links.rocker, crank, hull);
}

/// The part of hullWrench that is not the change of linkMomentum: weight and motion of the hull.
inline HullWrench frameWrench(const HullModel& model, const LinkMotion& links, double speed,
                              const HullMotion& hull) noexcept {
  if (model.level() != Level::kPulse) return frameWrench(model.mechanism(), model.level(), links, speed, hull);
  return {0.0, model.mechanism().parameters().rocker_mass * hull.gravity.z, 0.0};
}
inline HullWrench frameWrench(const HullModel& model, CrankAngle angle, double speed, const HullMotion& hull) noexcept {
  return frameWrench(model, linksAt(model, angle).links, speed, hull);
}

/// Momentum whose change is minus the impulse of hullWrench without frameWrench between blows.
inline LinkMomentum linkMomentum(const HullModel& model, const LinkMotion& links, CrankAngle angle,
                                 double speed) noexcept {
  if (model.level() == Level::kPulse) return linkMomentumPulse(model.nominalPulse(), angle, speed);
  return linkMomentum(model.mechanism(), model.level(), links, speed);
}
inline LinkMomentum linkMomentum(const HullModel& model, CrankAngle angle, double speed) noexcept {
  return linkMomentum(model, linksAt(model, angle).links, angle, speed);
}

/// Angles of the links against the hull, as the robot description defines them, and their rates.
struct LinkState {
  double crank_angle{};         ///< in [0, 2 pi) [rad]
  double rod_angle{};           ///< beta [rad]
  double rocker_angle{};        ///< psi [rad]
  double crank_speed{};         ///< [rad/s]
  double rod_speed{};           ///< [rad/s]
  double rocker_speed{};        ///< [rad/s]
  double transmission_angle{};  ///< psi - beta in [0, pi] [rad]; 0 at the blow only
};

/// Angle in [0, 2 pi) [rad].
inline double crankAngle(CrankAngle angle) noexcept {
  return angle.offset < 0.0 ? angle.offset + kTwoPi : angle.offset;
}

inline LinkState linkState(const LinkMotion& links, CrankAngle angle, double speed) noexcept {
  return {crankAngle(angle), rodAngle(links),        rockerAngle(links.rocker), speed,
          links.v * speed,   links.rocker.u * speed, transmissionAngle(links)};
}

/// Blow by the change of the crank's speed; if that is not known, the crank keeps its speed.
inline RockerBlow measuredBlow(const HullModel& model, const CrankBlow& crank) noexcept {
  if (!(crank.drive_inertia > 0.0)) return blowAtCrankSpeed(model.mechanism(), model.level(), crank.speed);
  return measuredBlow(model.mechanism(), model.level(), crank);
}

/// Reaction of the drive on the hull at the model's level; Jc [kg m2].
inline DriveReaction driveReaction(const HullModel& model, double drive_inertia) noexcept {
  return driveReaction(model.mechanism(), model.level(), drive_inertia);
}

/// Wrench BY links and drive ON the hull.
inline HullWrench hullWrench(const HullModel& model, const DriveReaction& drive, const CrankMotion& crank,
                             const HullMotion& hull) noexcept {
  HullWrench wrench = hullWrench(model, crank, hull);
  wrench.torque_y += drive.torque(crank.acceleration, hull.acceleration);
  return wrench;
}

/// Wrench on the hull from the motion of the links at crank.angle, which the caller has computed.
inline HullWrench hullWrench(const HullModel& model, const DriveReaction& drive, const LinkMotion& links,
                             const CrankMotion& crank, const HullMotion& hull) noexcept {
  HullWrench wrench = hullWrench(model, links, crank, hull);
  wrench.torque_y += drive.torque(crank.acceleration, hull.acceleration);
  return wrench;
}

/// Models of the other hammers of MachineColumns; in their order.
class WrenchColumns {
 public:
  using Matrix = MachineColumns::Effect;  ///< rows: force_x [N], force_z [N], torque_y [N m]

  explicit WrenchColumns(const HullModel& model);
  WrenchColumns(const WrenchColumns&) = delete;
  WrenchColumns& operator=(const WrenchColumns&) = delete;

  bool isExact() const noexcept { return models_.empty(); }
  /// Change of the hull wrench at a given motion of the crank, by one standard deviation each; drive_inertia: Jc
  /// [kg m2]. No allocation.
  Matrix wrench(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                const HullMotion& hull) const noexcept;
  /// Prepares wrench() for many calls, in some milliseconds.
  void tabulate();
  /// Sources in the columns' order, as MachineColumn::name.
  std::vector<std::string> names() const;
  /// Hammers in the columns' order, each a part `step` of its constant's deviation away (MachineColumn).
  const std::vector<HullModel>& models() const noexcept { return models_; }
  double step(std::size_t i) const noexcept { return columns_->columns()[i].step; }

 private:
  /// Wrench per square of the speed, per acceleration, per gravity along x and along z.
  using Table = ColumnTable<12>;

  Matrix evaluate(double drive_inertia, const LinksAtAngle& at, const CrankMotion& crank,
                  const HullMotion& hull) const noexcept;

  const HullModel* model_;
  std::shared_ptr<const MachineColumns> columns_;
  std::vector<HullModel> models_;
  std::optional<Table> table_;
};

}  // namespace hammer_loads
