/// The blow: instantaneous impulses of the rocker on the tool and on its support.
#pragma once

#include <limits>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {

/// Angular speeds are psi' (positive about hull +y); axes of hammer_hull.
struct RockerBlow {
  double crank_speed_before{};   ///< [rad/s]; 0 of blowInSupport
  double crank_speed_after{};    ///< crank speed just after the blow [rad/s]; 0 of blowInSupport
  double rocker_speed_before{};  ///< [rad/s], < 0 for a real blow
  double rocker_speed_after{};   ///< [rad/s]
  double restitution{};          ///< R = -after/before [-]
  double energy{};          ///< energy transferred to the tool along z: the links' loss less the work of friction [J]
  double friction_work{};   ///< work of friction at the striking face in both phases [J], >= 0
  double tool_impulse_x{};  ///< BY the tool ON the rocker [N s]
  double tool_impulse_z{};  ///< BY the tool ON the rocker [N s], > 0 for a real blow
  double support_impulse_x{};  ///< BY the links ON the hull [N s]; of blowInSupport: BY the rocker at D
  double support_impulse_z{};  ///< BY the links ON the hull [N s]; of blowInSupport: BY the rocker at D
  double support_impulse_y{};  ///< BY the links ON the hull about D [N m s]; 0 of blowInSupport
  double drive_impulse_y{};    ///< BY the drive's rotor ON the hull about +y [N m s]; 0 where nothing is known of it
  double restitution_std{std::numeric_limits<double>::quiet_NaN()};  ///< standard, where R was measured [-]
  double energy_std{std::numeric_limits<double>::quiet_NaN()};       ///< standard, where R was measured [J]
  /// restitution or energy are impossible by more than two deviations: both are NaN
  bool impossible{};
};

/// A blow as measured by the change of the crank's speed.
struct CrankBlow {
  double speed{};          ///< crank speed just before the blow [rad/s], > 0
  double speed_std{};      ///< standard [rad/s]
  double factor{1.0};      ///< k: crank speed after over before [-]
  double factor_std{};     ///< standard [-]
  double drive_inertia{};  ///< Jc [kg m2], > 0
  double inertia_std{};    ///< standard, relative [-]
  bool early{};            ///< the rocker met the tool before the dead centre
};

/// Point in hammer_hull axes, from the pivot D [m].
struct HullPoint {
  double x{};
  double z{};
};

/// Rocker at the instant of its blow; any shape, P1 fig. 1.
struct StrikingRocker {
  double mass{};                 ///< [kg], > 0
  double inertia_about_pivot{};  ///< J about D [kg m2], > 0
  HullPoint com;                 ///< C of P1
  HullPoint rod_joint;           ///< N of P1, pin C of the linkage
  double reduced_rod_mass{};     ///< m_n: rod mass reduced to the joint [kg], >= 0
  HullPoint striking_point;      ///< K; x < 0 for a rocker that strikes with psi' < 0
  double friction{};             ///< f between rocker and tool [-], >= 0
};

/// Rocker of the mechanism at psi = 0: S on -x, K at the striking offset over that line, joint C at the angle C-D-S.
/// Level linkage: m_n = J2/l2^2 (J2: rod about B): crank and B keep their speed, C's jumps. At the other levels the rod
/// is massless. Neglects the impulse along rod and rocker that a rod's centre of mass off its line needs (A and D share
/// it).
StrikingRocker strikingRocker(const Mechanism& mechanism, Level level) noexcept;

/// Blow by P1 (1)-(9) for given rocker speeds psi' before and after [rad/s], x_K of the sign of the speed before and f
/// |z_K| < |x_K| (else the tool jams the rocker). Coulomb's friction opposes the sliding of K, which ends together with
/// the approach and runs back in the rebound; a face that does not slide (z_K = 0) transmits no impulse along x.
/// Deviates: P1 keeps the direction of friction in the rebound (equal for R = 0), loses its sign in (3)-(5), (8), (9),
/// and keeps friction in (10), where nothing slides (model.md 5, 7).
RockerBlow blowInSupport(const StrikingRocker& rocker, double speed_before, double speed_after) noexcept;

/// Centre of mass for which the support gets no impulse [m], by the speeds before and after [rad/s]; with f z_K = 0
/// they do not matter. Deviates: P1 (12), (13) print brackets and a sign wrong and hold for R = 0; (18) is the special
/// case f = 0, z_K = 0, m_n = 0.
HullPoint idealCentreOfMass(const StrikingRocker& rocker, double speed_before, double speed_after) noexcept;

/// Blow of a crank that passes it forward at a speed w > 0 [rad/s]: the crank keeps its speed, the rocker's jumps from
/// u(2 pi -) w to u(0 +) w (model.md 1).
RockerBlow blowAtCrankSpeed(const Mechanism& mechanism, Level level, double crank_speed) noexcept;

/// Blow measured by its factor on the crank's speed. Restitution, speeds of the rocker, tool impulse and energy are
/// those between rocker and tool, before the linkage accelerates the rocker (BlowInertia); the support's impulse is
/// that of the links' whole change of momentum, to u+ k w-. Level pulse: as rocker. If the tool is met early, the rod
/// couples the rocker to the crank: the tool receives the momentum that both lose, and the restitution is not known.
RockerBlow measuredBlow(const Mechanism& mechanism, Level level, const CrankBlow& crank) noexcept;

/// Blow of a crank that does not keep its speed: [rad/s] before, > 0, and after.
RockerBlow blowAtCrankSpeeds(const Mechanism& mechanism, Level level, double before, double after) noexcept;

/// Voids an impossible blow: restitution outside [0, 1] or energy outside [0, energy of the rocker] by more than two
/// deviations. Its restitution and energy become NaN and `impossible` true. A blow without deviations stays as it is.
void voidImpossible(const Mechanism& mechanism, Level level, RockerBlow& blow) noexcept;

}  // namespace hammer_loads
