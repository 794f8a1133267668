/// The hammer on a boom that stands on the oil of its cylinders: crank, flywheel, hull and boom as one coupled system.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/moving_links.h"

namespace hammer_loads::simulation {

/// A place in a vertical plane, x + i z [m]; a turn by q about +y is e^(-iq).
using PlanePoint = std::complex<double>;

/// A link from its joint on, in its own axes.
struct OilBoomLink {
  PlanePoint to_next;  ///< next joint; of the last link: the rocker's pivot D
  PlanePoint com;
  double mass{};     ///< [kg]
  double inertia{};  ///< about the centre of mass, about y [kg m2]
};

/// Cylinder of a joint; anchors from the joint: base in the axes of the link before, rod in those of the link beyond.
struct OilCylinder {
  PlanePoint base, rod;
  double bore_area{}, rod_area{};                             ///< [m2]
  double closed_length{}, stroke{}, bore_hose{}, rod_hose{};  ///< [m], [m], [m3], [m3]
};

/// Boom, arm, bracket with hull; the hull's mass and inertia include those of the moving links and of the rotor.
struct OilBoom {
  std::array<OilBoomLink, 3> links;
  std::array<OilCylinder, 3> cylinders;
  std::array<double, 3> pose;  ///< of the joints [rad]
  double bulk_modulus{};       ///< [Pa]
  double damping{};            ///< ratio of every mode
  PlanePoint cut;              ///< of the first link
  OilBoomLink beyond_cut;      ///< of that link's own part beyond it; to_next not used
};

/// Excavator EO-2621 at work, cut in the middle of its boom; figures by hand from its description.
OilBoom oilBoomEo2621();

/// What there is to know at one instant.
struct OnBoomTruth {
  double time{}, angle{}, speed{}, acceleration{};  ///< of the crank: [s], in [0, 2 pi) [rad], [rad/s], [rad/s2]
  Load load;                     ///< BY links and rotor ON the hull about D, hull axes, weight included
  double drive_reaction_y{};     ///< part of its moment [N m]
  Eigen::Vector3d hold;          ///< BY the cylinders ON the joints [N m]
  Eigen::Vector3d displacement;  ///< of the joints by vibration [rad]
  Load cut;                      ///< BY what lies beyond the cut ON what lies before it, about it, axes of the link
  double imu_x{}, imu_z{};       ///< specific force at D, hull axes [m/s2]
  double imu_rate{};             ///< about +y [rad/s]
  std::array<double, 3> bore_pressure{}, rod_pressure{};  ///< gauge [Pa]; the unloaded chamber at 0 when at rest
};

/// One blow: the rocker leaves the tool as its linkage lets it, without an impulse within the linkage.
struct OnBoomBlow {
  double time{};
  double energy{};        ///< given to the tool, which rests on the rock [J]
  double tool_impulse{};  ///< BY the tool ON the rocker along +z of the hull [N s]
};

/// Coordinates: three joint angles and the crank's. Kinetic energy by the places of all bodies, forces of inertia by
/// differences of the mass matrix, accelerations of bodies by differences in time. Runge-Kutta of order 4.
/// Level rocker; the joints' own slow motion is left out.
class HammerOnBoom {
 public:
  HammerOnBoom(const MachineSettings& machine, const OilBoom& boom);

  void advanceTo(double time);
  OnBoomTruth truth() const;
  const std::vector<OnBoomBlow>& blows() const noexcept { return blows_; }

 private:
  using Vector4 = Eigen::Vector4d;
  using Matrix4 = Eigen::Matrix4d;
  struct State {
    double time{};
    bool before_blow{};
    Vector4 x, v;       ///< joints' displacements, crank's offset from its nearest dead centre
    double pressure{};  ///< at the motor [Pa]
  };
  /// A moving body: its place, and what each coordinate does to place and angle.
  struct Body {
    double mass{}, inertia{};
    PlanePoint place;
    std::array<PlanePoint, 4> by;
    Vector4 turn;
  };
  using Bodies = std::array<Body, 4>;  ///< links, then the rocker

  Bodies bodies(const State& s) const;
  Matrix4 massMatrix(const State& s) const;
  Vector4 weight(const State& s) const;
  Vector4 force(const State& s, const Vector4& inertia) const;
  Vector4 acceleration(const State& s) const;
  double pressureRate(const State& s) const;
  State stepped(const State& s, double dt) const;
  void blow();
  Eigen::Vector3d holding(const State& s) const;
  double lengthOf(int cylinder, double angle) const;
  double arm(int cylinder, double angle) const;
  double hullAngle(const State& s) const;
  PlanePoint jointPlace(const State& s, int joint) const;
  Load loadOf(const State& s, const Vector4& a, int first, PlanePoint about, double axes) const;
  State along(const State& s, const Vector4& a, double dt) const;

  MachineSettings machine_;
  OilBoom boom_;
  MovingLinks links_;
  double rotor_{}, ratio_{};  ///< Jc [kg m2], drive_reaction_ratio
  Eigen::Vector3d stiffness_, hold_;
  Eigen::Matrix3d damping_;
  State now_;
  std::vector<OnBoomBlow> blows_;
};

}  // namespace hammer_loads::simulation
