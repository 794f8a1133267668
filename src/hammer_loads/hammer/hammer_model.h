/// Interface of the hammer model for the other rooms: loads, momentum, blow, links and pins of one mechanism at one
/// level. They include this header alone, so that another linkage can replace the present one.
#pragma once

#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/pin_forces.h"

namespace hammer_loads {

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

inline LinkState linkState(const LinkMotion& links, const CrankMotion& crank) noexcept {
  return {crankAngle(crank.angle),   rodAngle(links),
          rockerAngle(links.rocker), crank.speed,
          links.v * crank.speed,     links.rocker.u * crank.speed,
          transmissionAngle(links)};
}
inline LinkState linkState(const HullModel& model, const CrankMotion& crank) noexcept {
  return linkState(linkMotion(model.mechanism().linkage(), crank.angle), crank);
}

/// Forces in the pins and drive torque at the model's level; links: at the crank's angle; near_blow: transmission angle
/// below which they are flagged, angle_error: of the crank, within which of the blow they are NaN [rad].
inline PinReactions pinForces(const HullModel& model, const LinkMotion& links, const CrankMotion& crank,
                              const HullMotion& hull, double near_blow, double angle_error = 0.0) noexcept {
  return pinForces(model.mechanism(), model.level(), links, crank, hull, NearBlow(near_blow, angle_error));
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

/// Wrench on the hull at one crank angle for any speed [rad/s] and acceleration [rad/s2]. The links' motion is computed
/// once. The object refers to its arguments.
class WrenchAtAngle {
 public:
  WrenchAtAngle(const HullModel& model, const DriveReaction& drive, const HullMotion& hull,
                const LinksAtAngle& at) noexcept
      : model_(model), drive_(drive), hull_(hull), at_(at) {}
  HullWrench operator()(double speed, double acceleration) const noexcept {
    HullWrench wrench = hullWrench(model_, at_.links, {at_.angle, speed, acceleration}, hull_);
    wrench.torque_y += drive_.torque(acceleration, hull_.acceleration);
    return wrench;
  }

 private:
  const HullModel& model_;
  const DriveReaction& drive_;
  const HullMotion& hull_;
  const LinksAtAngle& at_;
};

/// Wrench by motion relative to the hull alone, without weight and in a hull at rest.
inline HullWrench motionWrench(const HullModel& model, const DriveReaction& drive, const LinkMotion& links,
                               const CrankMotion& crank) noexcept {
  return hullWrench(model, drive, links, crank, Gravity{});
}

}  // namespace hammer_loads
