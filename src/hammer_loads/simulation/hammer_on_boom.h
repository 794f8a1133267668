/// The hammer on a boom supported by the oil of its cylinders: crank, flywheel, hull and boom as one coupled system.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "hammer_loads/simulation/elastic_links.h"
#include "hammer_loads/simulation/moving_links.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/oil_boom.h"
#include "hammer_loads/simulation/struck_tool.h"
#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

/// Readings of the boom's sensors, without their errors.
struct OnBoomSensors {
  Eigen::Vector3d angles{Eigen::Vector3d::Zero()};        ///< angles of the joints [rad]
  Eigen::Vector3d rates{Eigen::Vector3d::Zero()};         ///< [rad/s]
  double imu_x{}, imu_z{};                                ///< specific force at the unit, in its axes [m/s2]
  double imu_rate{};                                      ///< angular rate about +y [rad/s]
  std::array<double, 3> bore_pressure{}, rod_pressure{};  ///< gauge [Pa]
};

/// The truth at one instant.
struct OnBoomTruth : CrankTruth, OnBoomSensors {
  Eigen::Vector3d displacement{
      Eigen::Vector3d::Zero()};  ///< displacement of the joints from the pose in which the operator holds them [rad]
  Eigen::Vector3d hold{Eigen::Vector3d::Zero()};  ///< torque BY the cylinders ON the joints [N m]
  Load rock;                ///< load BY the rock ON the hull's foot, without blows, about D, axes of the hull
  std::array<Load, 3> cut;  ///< load BY the steel beyond each cut ON that before it, about the cut, axes of the link
};

/// The coordinates are the angles of boom, arm, hull and crank. The kinetic energy follows from the positions of all
/// bodies, the loads from their accelerations by differences in time. Integration by Runge-Kutta of order 4.
/// The operator's valves move the equilibrium of each joint along settings.boom. The oil is a linear spring about it,
/// with the stiffness at that pose. With air, leakage past the pistons or loose pins, each cylinder has two chambers,
/// whose pressures follow from the rod's displacement and the leaked volume. A link bends at a spring hinge in its
/// middle, which rotates everything beyond it; the link's own mass does not move. The seals of settings.on_boom.seals
/// act on the rods: the pressures are those of the oil, and oil and seals together hold the joints.
///
/// A blow changes the velocities of the hull and all links; the rocker leaves the tool without an impulse within the
/// linkage, or with a drawn restitution. settings.on_boom.rock supports a hull that is pressed on the tool; without it
/// the hull hangs free and the rock supports the tool alone. The boom's swing about the vertical is neglected. With an
/// elastic settings.rod the rocker is a separate coordinate and the blow follows from the contact, as in
/// ElasticMachine. The contact force acts on rocker, hull and boom; the tool moves as in a hull at rest. Force and
/// impulses of the revolution in BlowTruth are NaN.
class HammerOnBoom {
 public:
  /// Uses level rocker and a rigid coupling. Throws std::invalid_argument when the hammer's linkage is impossible.
  explicit HammerOnBoom(const MachineSettings& machine, const OilBoom& boom = oilBoomEo2621());

  /// time >= now [s].
  void advanceTo(double time);
  OnBoomTruth truth() const;
  OnBoomSensors sensors() const;  ///< the part of truth() that needs no loads
  /// Removes and returns the blows since the last call.
  std::vector<BlowTruth> takeBlows();
  /// Returns the natural frequencies [Hz] on the oil alone at the operator's pose at a time, lowest first.
  Eigen::Vector3d frequencies(double time) const;

 private:
  /// Angles of joints, crank and rocker, and bends of boom and arm. With a rigid rod the fifth stays zero, since the
  /// crank moves the rocker. With rigid links the last two stay zero.
  using Coordinates = Eigen::Matrix<double, 7, 1>;
  using Inertia = Eigen::Matrix<double, 7, 7>;
  /// Elements of a state after the coordinates and their speeds.
  enum Index {
    kPressure = 14,            // pressure at the motor [Pa]
    kLeaked,                   // oil leaked in each cylinder, from bore to rod side [m3]
    kSheared = kLeaked + 3,    // displacement of each cylinder's seals before they slide [m]
    kTool = kSheared + 3,      // ToolState of an elastic machine; its impulses and energy follow
    kToolImpulse = kTool + 3,  // since the start [N s]
    kToolEnergy,               // [J]
    kRetainerImpulse,          // [N s]
    kSize
  };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  struct State {
    double time{};
    bool before_blow{};
    bool resting{};  ///< the crank ran back onto the tool and is held at the dead centre, as by a brake
    Vector y{Vector::Zero()};
    auto x() { return y.head<7>(); }  ///< angles of the joints, crank's offset from its nearest dead centre, rocker
    auto x() const { return y.head<7>(); }
    auto v() { return y.segment<7>(7); }
    auto v() const { return y.segment<7>(7); }
    auto leaked() const { return y.segment<3>(kLeaked); }
    auto sheared() const { return y.segment<3>(kSheared); }
    ToolState tool() const { return {y[kTool], y[kTool + 1], y[kTool + 2]}; }
  };
  /// Moving body: its position, and the derivatives of position and angle by each coordinate.
  struct Body {
    double mass{}, inertia{};
    PlanePoint place;
    Coordinates x, z, turn;
  };
  /// Links, then the rocker, which moves within the hull.
  struct Bodies {
    std::array<Body, 4> body;
    std::array<PlanePoint, 4> joint;   ///< joints of the links, then the rocker's pivot D
    std::array<PlanePoint, 2> middle;  ///< middles of boom and arm, where they bend
    std::array<double, 3> angle;       ///< angles of the links
    PlanePoint hull_turned;
  };

  /// Pose in which the operator holds the joints, and the torques and stiffnesses that hold them there.
  struct Hold {
    State state;
    Eigen::Vector3d weight;     ///< torque of all weights on the joints [N m]
    Eigen::Vector3d stiffness;  ///< stiffness of the oil about the joints [N m/rad]
    Eigen::Vector2d bent;       ///< torque of the weights on the bends [N m]; the links are straight under it
  };
  /// Elastic rod and the target of the rocker.
  struct Elastic {
    ElasticLinks links;
    RodSpring rod;
    StruckTool struck;
  };
  using Links = std::array<OilBoomLink, 3>;
  using Rocker = LinkBodies::Body;  ///< in the mechanism frame

  void takeMovingPartsOffTheHull();
  State heldAt(double time) const;
  Hold holdAt(double time) const;

  int rockerIndex() const { return elastic_ ? 4 : 3; }  ///< index of the coordinate that moves the rocker
  Rocker rockerAt(const State& s) const;
  double rockerOf(double crank_angle) const { return elastic_ ? elastic_->links.rockerAngle(crank_angle) : 0.0; }
  Bodies bodies(const State& s, const Links& links, const Rocker& rocker) const;
  void turnAbout(const Bodies& all, Body& body, std::size_t joints) const;
  Bodies bodies(const State& s) const { return bodies(s, boom_.links, rockerAt(s)); }
  Bodies heldBodies(const State& held) const { return bodies(held, boom_.links, held_rocker_); }
  Inertia rotorInertia() const;
  Inertia massMatrix(const Bodies& all) const;
  Coordinates weight(const Bodies& all) const;
  Eigen::Vector3d stiffness(const State& held, const Eigen::Vector3d& weight) const;
  double oilOf(std::size_t cylinder) const;  ///< bulk modulus [Pa]
  /// Gauge pressures of a cylinder [Pa].
  struct Chambers {
    double bore{}, rod{};
  };
  Chambers heldChambers(std::size_t k, const State& held, double weight) const;
  Chambers chambersAt(std::size_t k, double way, double leaked, const Hold& hold) const;
  Chambers chambers(std::size_t k, const State& s, const Hold& hold) const;
  double push(std::size_t k, const Chambers& at) const;  ///< outward push of the rod [N]
  Eigen::Vector3d leak(const State& s, const Hold& hold) const;
  Eigen::Vector3d shear(const State& s) const;
  void followOperator();
  Eigen::Vector3d oil(const State& s, const Hold& hold) const;
  Eigen::Vector3d seals(const State& s, const Eigen::Vector3d& oil) const;
  Eigen::Vector3d holding(const State& s, const Hold& hold) const;
  PlanePoint footPlace(const State& s) const;
  /// Position of the hull's foot along the tool, relative to that at the operator's pose.
  struct Foot {
    double height{}, speed{};  ///< [m], [m/s]
    Coordinates lift;          ///< derivatives of the height by the coordinates [m/rad]
  };
  Foot foot(const State& s, const State& held) const;
  void standOnRock();
  double rockHeight(const Hold& hold) const;
  double rockForce(const Foot& foot) const;
  Load rockLoad(const State& held) const;
  Coordinates force(const State& s, const Bodies& all, const Hold& hold) const;
  Coordinates inertiaOfSpeeds(const State& s, const Bodies& all, const Rocker& rocker) const;
  Coordinates acceleration(const State& s, const Hold& hold) const;
  StruckTool::Striker striker(const State& s) const;
  StruckTool::Answer struck(const State& s) const;
  double gravityDown(const State& s) const;
  Coordinates elasticForce(const State& s) const;
  Coordinates toolLift(const State& s) const;
  PlanePoint strikingPlace(const State& s) const;
  int contacts(const State& s) const;
  Hold holdBetween(double time) const;
  void advanceElastic(double time);
  void acceptElastic(const State& next);
  Vector rate(const State& s, const Hold& hold) const;
  State stepped(const State& s, double dt) const;
  double timeToDeadCentre(double dt) const;
  void release();
  void passDeadCentre();
  void blow();
  void endTurn(BlowTruth& blow);

  bool bends() const { return machine_.on_boom.bending_frequency > 0.0; }
  void stiffenLinks();
  /// Number of hinges: the joints, then the middles of boom and arm. Each rotates everything beyond it.
  std::size_t turns() const { return bends() ? 5 : 3; }
  static int turnIndex(std::size_t turn) { return static_cast<int>(turn < 3 ? turn : turn + 2); }
  PlanePoint turnPlace(const State& s, std::size_t turn) const;
  static double hullTurning(const Coordinates& c) { return c.head<3>().sum() + c.tail<2>().sum(); }
  /// Returns the angle of the link that ends in a joint, up to its middle; bentAngle returns that beyond the middle.
  static double angleBefore(const State& s, std::size_t joint);
  static double bentAngle(const State& s, std::size_t link) {
    return angleBefore(s, link + 1) + (link < 2 ? s.x()[5 + static_cast<int>(link)] : 0.0);
  }
  PlanePoint middleOf(std::size_t link) const { return link < 2 ? 0.5 * boom_.links[link].to_next : 0.0; }
  static double hullAngle(const State& s) { return angleBefore(s, 3); }
  PlanePoint jointPlace(const State& s, std::size_t joint) const;
  PlanePoint imuPlace(const State& s) const;
  State along(const State& s, const Coordinates& a, double dt) const;
  /// States at, after and before an instant, for accelerations by differences in time.
  struct Moments {
    State state[3];
    Rocker rocker[3];
  };
  Moments momentsAbout(const Coordinates& a) const;
  /// Returns the load of the bodies from `first` on, without supporting forces, about a place in axes at an angle.
  Load loadOf(const Coordinates& a, const Moments& m, const Links& links, std::size_t first, PlanePoint about,
              double axes) const;
  Load cutLoad(const OnBoomTruth& t, const Coordinates& a, const Moments& m, const OilBoomCut& cut) const;
  OnBoomSensors sensors(const Hold& hold, const Coordinates& a) const;
  void readCylinders(const Hold& hold, OnBoomSensors& s) const;

  MachineSettings machine_;
  OilBoom boom_;
  MovingLinks links_;
  double rotor_{}, ratio_{};  ///< Jc [kg m2], drive_reaction_ratio
  Rocker held_rocker_{};      ///< rocker in every state of heldAt()
  Hold hold_;                 ///< at the beginning of the present step
  Hold hold_later_;           ///< settings.on_boom.step later; the steps of an elastic machine lie between the two
  Eigen::Matrix3d damping_;
  Eigen::Vector2d link_stiffness_{Eigen::Vector2d::Zero()}, link_damping_{Eigen::Vector2d::Zero()};
  double rock_height_{};  ///< height of the rock over the foot of a hull that is held without rock [m]
  double step_{};         ///< longest step [s]
  State now_;
  std::int64_t turn_{};
  double last_blow_{}, released_{-1.0};  ///< [s]
  bool whole_turn_{};
  NormalNoise draws_;
  std::vector<BlowTruth> blows_;
  std::optional<Elastic> elastic_;
  double next_step_{};  ///< [s]
  BlowFollower follower_;
};

}  // namespace hammer_loads::simulation
