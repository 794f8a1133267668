/// Crank and rocker as two bodies, the rod between them a spring: how they move after a blow.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// Crank on a branch or its continuation past the blow, and the rocker's displacement from that with a rigid rod.
struct TwoBodyState {
  CrankAngle angle;
  double speed{};              ///< w [rad/s]
  double displacement{};       ///< x = psi - psi of a rigid rod [rad]
  double displacement_rate{};  ///< rate of x [rad/s]
};

/// Returns rigid links with the displaced rocker: rock of high rebound throws it back by a tenth of a radian.
inline LinkMotion withRocker(LinkMotion rigid, double displacement) noexcept {
  const SineCosine turned = sineCosine(displacement);
  rigid.psi = rigid.psi * Planar{turned.cosine, turned.sine};
  return rigid;
}

/// Loads that drive the two bodies.
struct TwoBodyDrive {
  double inertia{};  ///< Jc [kg m2]
  double torque{};   ///< net torque on the crank [N m]
  Gravity gravity;
};

struct TwoBodyAccelerations {
  double crank{}, rocker{};  ///< [rad/s2]
  double tension{};          ///< force in the rod [N]
};

/// With independent angles phi and psi, theta = psi - phi, and a rod whose masses move in proportion between its pins,
/// kinetic energy is 1/2 (M11 w^2 + 2 M12(theta) w v + M22 v^2), M11 and M22 constant (as BlowInertia). In phi and x:
///
///     J w' + B x'' = F1 - T g,  B w' + M22 x'' = F2 + T h,  J = M11 + 2 u M12 + u^2 M22,  B = M12 + u M22
///
/// h = l3 sin(psi - beta) is the rod's lever, g = d(stretch)/d(phi), in proportion to x: a third of h after a rebound
/// that has thrown the rocker far; T = -k h x - c (h x)' is its tension. A step solves the oscillator (M22 - B^2/J) x''
/// with the lever at its middle in closed form: exact for any stiffness and damping, and closer to the rigid mechanism
/// the stiffer the rod. Coulomb friction of the four pins brakes their rotation by the moment r |T| each, r the radius
/// of their friction circles; its sign is continuous within 0.5 rad/s. Neglects: bending of the links, motion of the
/// hull except its effective gravity, forces of the pins other than T.
class TwoBodies {
 public:
  /// Refers to the mechanism, which must outlive it.
  explicit TwoBodies(const Mechanism& mechanism) noexcept;

  /// Links of a rigid rod at the last angle that was evaluated.
  struct LinksMemo {
    CrankAngle angle{std::numeric_limits<double>::quiet_NaN()};
    LinkMotion links;
  };
  /// Moves a state by dt [s] > 0 with constant levers: half a millisecond near the blow, one elsewhere. The step is
  /// split where pins with joint clearance separate or meet. memo: shared by moves of other states from the same angle.
  void move(const RodSpring& rod, const TwoBodyDrive& drive, double dt, TwoBodyState& state,
            LinksMemo& memo) const noexcept;
  void move(const RodSpring& rod, const TwoBodyDrive& drive, double dt, TwoBodyState& state) const noexcept {
    LinksMemo memo;
    move(rod, drive, dt, state, memo);
  }
  /// Returns the accelerations and the tension of the rod at a state.
  TwoBodyAccelerations accelerations(const RodSpring& rod, const TwoBodyDrive& drive, const TwoBodyState& state,
                                     const LinkMotion& links) const noexcept;
  /// Acceleration of the crank with a rigid connecting rod [rad/s2].
  double rigidAcceleration(const TwoBodyDrive& drive, const TwoBodyState& state,
                           const LinkMotion& links) const noexcept;
  /// The rod's value in LinkAccelerations includes its change of length.
  LinkAccelerations linkAccelerations(const TwoBodyState& state, const TwoBodyAccelerations& a,
                                      const LinkMotion& links) const noexcept;
  /// Links' speeds times i in the form of accelerations, so that hullWrenchOf() returns minus their momentum.
  LinkAccelerations linkSpeeds(const TwoBodyState& state, const LinkMotion& links) const noexcept;
  const Mechanism& mechanism() const noexcept { return *mechanism_; }
  LinkMotion links(CrankAngle angle) const noexcept { return linkMotion(mechanism_->linkage(), angle); }
  /// Sets x to the rest position of the rod's spring at the motion of the crank, and its rate to 0.
  void settle(const RodSpring& rod, const TwoBodyDrive& drive, TwoBodyState& state) const noexcept;
  /// Position of the tool and restitution of the rocker on it.
  struct Tool {
    double place{};        ///< psi [rad]
    double restitution{};  ///< [-]
  };
  /// Time of a blow [s], and the states before and after it.
  struct Blow {
    double time{};
    TwoBodyState before, after;
  };
  /// Moves the state by dt like move(), with a blow where the rocker reaches the tool. Returns that blow; its time
  /// counts from the beginning of the step [s].
  std::optional<Blow> moveToTool(const RodSpring& rod, const TwoBodyDrive& drive, const Tool& tool, double dt,
                                 TwoBodyState& state, LinksMemo& memo) const noexcept;
  /// Changes a state just before its blow into one that was struck already, by the path back on both sides (saltation).
  void strikeEarly(const TwoBodyDrive& drive, const Tool& tool, TwoBodyState& state) const noexcept;

 private:
  LinkAccelerations withRod(Planar crank, Planar rocker, const LinkMotion& links) const noexcept;
  void strike(const TwoBodyDrive& drive, double restitution, TwoBodyState& state) const noexcept;
  struct Local;
  Local local(const TwoBodyDrive& drive, const TwoBodyState& at, const LinkMotion& links) const noexcept;

  void addFriction(double moment, const TwoBodyState& at, const LinkMotion& links, Local& a) const noexcept;

  const Mechanism* mechanism_;
  double crank_, rocker_;                ///< M11 less Jc, M22 [kg m2]
  Planar coupling_;                      ///< M12 = Re(coupling e^(i theta)) [kg m2]
  Planar crank_weight_, rocker_weight_;  ///< first moments that turn with the angles [kg m]
};

}  // namespace hammer_loads
