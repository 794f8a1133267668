/// Boom: loads of joints and cylinders from its motion and the hammer's wrench.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/hold_down.h"
#include "hammer_loads/boom/load_errors.h"
#include "hammer_loads/boom/steel_loads.h"
#include "hammer_loads/boom/vibration.h"
#include "hammer_loads/boom/vibration_spread.h"
#include "hammer_loads/util/inline.h"
#include "hammer_loads/util/known_count.h"

namespace hammer_loads {

/// Parameters of the boom file; keys of the same names with the unit appended. Physical values have no defaults.
struct BoomParameters {
  ChainRequest chain;                         ///< root_link, tip_link; joints are those of the cylinders
  std::vector<CylinderParameters> cylinders;  ///< at most one per joint
  double bulk_modulus{};                      ///< bulk modulus of oil with hose and air [Pa], > 0
  VibrationSettings vibration;
  std::optional<Supports> supports;         ///< [m]; empty: not known
  std::vector<SectionParameters> sections;  ///< sections whose load is wanted; may be empty
  double link_mass_std{0.03};               ///< standard deviation of a link's mass, unless identified, relative [-]
  double link_com_std{0.02};                ///< standard deviation of its centre of mass, in x and z each [m]
  // Prior: link_mass_std, link_com_std
  double rigid_tolerance{};  ///< largest rigidError() for which the boom may be taken as rigid [-], > 0
};

/// Torques of the loads about the joints' axes [N m] ([N] for a prismatic joint); positive drives the joint forward.
/// The part that holds the joint, such as a cylinder, exerts the opposite of the total.
struct BoomLoads {
  JointVector hammer;                              ///< J^T w, as on a rigid boom
  JointVector weight;                              ///< weight of the links
  JointVector motion;                              ///< inertia of the links as the boom moves
  JointVector vibration;                           ///< inertia of the links as the boom vibrates; zero for a rigid boom
  JointVector total;                               ///< sum of the four
  std::array<CylinderForce, kMaxJoints> cylinder;  ///< cylinder forces of the total, index as in Boom::cylinders()
};

/// Independent errors of the hammer's load, one standard deviation each.
struct WrenchSpread {
  int count{};                 ///< at most 4, for example by crank angle, speed, acceleration and rock
  std::array<Wrench, 4> part;  ///< loads on the tip
};

/// Standard deviations of the boom's loads. At a zero moment arm they are defined as in SteelLoads.
struct BoomDeviations {
  JointVector torque;                         ///< standard deviation of BoomLoads::total [N m]
  std::array<double, kMaxJoints> cylinder{};  ///< standard deviation of the cylinder's force [N]
  std::array<Wrench, kMaxSections> section;   ///< each component
  std::array<Wrench, kMaxJoints> joint;       ///< reactions at the joint, each component
};

/// Boom with its vibration. For each sample, call move() if the boom has moved, advance() if the vibration is needed,
/// then loads(). After make() nothing allocates or throws; loads() reports an input whose results are not finite.
class Boom {
 public:
  /// Makes a boom, or reports every problem of description and boom file at once, one line each.
  static Checked<Boom> make(const RobotDescription& description, const BoomParameters& parameters);
  /// Makes a boom from the description alone: rigid, no cylinders, supports not known.
  static Checked<Boom> make(const RobotDescription& description, const ChainRequest& request = {}) {
    BoomParameters parameters;
    parameters.chain = request;
    return make(description, parameters);
  }
  /// Makes the same boom without sections, with these identified bodies instead of those in its parameters. Returns
  /// nothing for impossible bodies. description: of this boom. Cylinders are not checked again, since bodies do not
  /// move them.
  std::optional<Boom> weighed(const RobotDescription& description, std::vector<WeighedLink> links) const;

  /// Moves the boom. motion: of the chain's joints; g_B: gravity in the root's axes [m/s2], (0, 0, -g) for a level
  /// base.
  void move(const JointMotion& motion, const Eigen::Vector3d& g_B) noexcept;
  /// Moves the boom and its vibration to this pose. Modes exist only after this call or moveVibrating().
  void moveCompliant(const JointMotion& motion, const Eigen::Vector3d& g_B) noexcept;
  /// Moves the boom by a motion without the vibration. The modes belong to the pose of this motion. The links are
  /// displaced in addition by the vibration, see Vibration::displacementAfter() [rad].
  void moveVibrating(const JointMotion& motion, const JointVector& displacement, const Eigen::Vector3d& g_B) noexcept;

  const ChainPose& pose() const noexcept { return pose_; }
  /// Motion of the joints at this pose, including the displacement that moveVibrating() was given.
  const JointMotion& motion() const noexcept { return joints_; }
  /// Gravity g_B in the tip's axes [m/s2], for the hammer's weight.
  Eigen::Vector3d gravityAtTip() const noexcept;
  /// Jacobian of the tip at the pose, see tipJacobian().
  const Jacobian& tipJacobian() const noexcept { return jacobian_; }
  /// Returns J^T w, the torque of a load on the tip about each joint's axis [N m] ([N] for a prismatic joint). Positive
  /// drives the joint forward. The part that holds the joint exerts the opposite.
  HAMMER_LOADS_INLINE JointVector hammerTorque(const Wrench& w_tip) const noexcept {
    JointVector torque(jacobian_.cols());
    withCount<4>(chain_.joints(), [&](auto joints) {
      for (int j = 0; j < joints; ++j)
        torque[j] = jacobian_.col(j).head<3>().dot(w_tip.force) + jacobian_.col(j).tail<3>().dot(w_tip.torque);
    });
    return torque;
  }

  /// Torque of weight and motion on a joint [N m].
  double steadyTorque(int joint) const noexcept { return weight_[joint] + motion_[joint]; }

  Vibration& vibration() noexcept { return vibration_; }
  const Vibration& vibration() const noexcept { return vibration_; }
  /// Displacement, velocity and acceleration of the tip by vibration, linear then angular, in the axes of the tip [m,
  /// rad and their 1/s, 1/s2].
  struct TipVibration {
    Eigen::Matrix<double, 6, 1> displacement, velocity, acceleration;
  };
  TipVibration tipVibration() const noexcept;
  /// Returns reduced mass and stiffness at the hull along a unit vector in the tip's axes, at the pose of the modes.
  /// They are infinite where the vibrating joints do not move the hull in this direction.
  ReducedHull reducedHull(const Eigen::Vector3d& direction) const noexcept;

  /// Returns the loads of the links' inertia and weight in the present motion. rigid: without vibration.
  ChainLoads chainLoads(bool rigid) const noexcept;
  /// Computes the loads. w_tip: load of the hammer on the tip from the motion of its moving links relative to the hull.
  /// It excludes their weight and the effect of the boom's motion, because the hull's mass in the description includes
  /// theirs. links: result of chainLoads(rigid), computed here if omitted. Returns false if the input is so large that
  /// a result is not finite and must not be used. NaN at a zero moment arm does not count.
  bool loads(const Wrench& w_tip, bool rigid, const ChainLoads& links, BoomLoads& result) const noexcept;
  bool loads(const Wrench& w_tip, bool rigid, BoomLoads& result) const noexcept {
    return loads(w_tip, rigid, chainLoads(rigid), result);
  }
  /// Computes section loads and joint reactions with the arguments and cylinder forces of loads().
  bool steelLoads(const Wrench& w_tip, const ChainLoads& links, SteelLoads& result) const noexcept;
  bool steelLoads(const Wrench& w_tip, bool rigid, SteelLoads& result) const noexcept {
    return steelLoads(w_tip, chainLoads(rigid), result);
  }
  /// Returns the joint torques by errors of a load, as input of VibrationSpread::advance().
  LoadSpread spreadTorque(const WrenchSpread& w_tip) const noexcept;
  /// Finds the standard deviations of loads() and steelLoads() by errors of the hammer's load and, unless rigid, of the
  /// oil. They exclude errors of masses, dimensions, weight and motion. The responses to errors are recomputed once a
  /// joint has moved by four times refresh_angle.
  void deviations(const VibrationSpread& spread, const WrenchSpread& w_tip, bool rigid,
                  BoomDeviations& result) noexcept;
  /// Finds the standard deviations by given errors, for example with measured cylinder forces.
  void deviations(const LoadErrors& errors, BoomDeviations& result) noexcept;
  /// Finds the standard deviations by errors of the load in the boom's plane alone (force x, z, moment y). Each column
  /// of tip is one standard deviation.
  void deviations(const Eigen::Matrix3d& tip, BoomDeviations& result) noexcept;
  /// Returns standard deviations of the weight's joint torques [N m] by errors of the links' masses and centres and of
  /// the joint sensors' zeros. They are constant at a pose. deviations() updates them; they are zero before.
  const JointVector& weightDeviation() const noexcept { return weight_std_; }
  /// Returns standard deviations of the joint torques by bending of the links in vibration [N m], zero without
  /// vibration. Masses beyond the middle of a link follow the joints; the link's own mass follows them less.
  /// deviations() updates the underlying responses.
  JointVector bendingDeviation() const noexcept;
  /// Returns the faults of a cylinder under these loads, a sum of CylinderFlag. The steady part is weight and motion.
  std::uint16_t flags(std::size_t cylinder, const BoomLoads& loads) const noexcept;
  /// Returns rigidError() for half-sine pulses of this peak and length [s], at the pose of the modes. It takes some 0.1
  /// ms, too long for each sample.
  double rigidError(const Wrench& w_peak, double pulse_length) const noexcept;
  /// Returns the factors by which weight and cylinders resist a mean load of the hammer on the tip, such as the mean
  /// hold-down force along +z at the striking line. The model is static, without sliding; supports on level ground
  /// carry pressure only.
  HoldDown holdDown(const Wrench& w_mean) const noexcept;

  const Chain& chain() const noexcept { return chain_; }
  /// Returns the joint sensors' readings at the description's zeros [rad], [m].
  JointVector jointZeros() const noexcept;
  /// Position of a cylinder at this pose.
  const CylinderPosition& cylinderPosition(std::size_t cylinder) const noexcept { return at_[cylinder]; }
  const std::vector<Cylinder>& cylinders() const noexcept { return cylinders_; }
  const std::vector<Section>& sections() const noexcept { return steel_.sections(); }
  const BoomParameters& parameters() const noexcept { return parameters_; }

 private:
  Boom(const Chain& chain, std::vector<Cylinder> cylinders, std::vector<Section> sections,
       const BoomParameters& parameters);

  Chain chain_;
  std::vector<Cylinder> cylinders_;
  BoomParameters parameters_;
  Vibration vibration_;
  SteelLoadFinder steel_;
  ChainPose pose_;
  PlacedBodies bodies_;
  Jacobian jacobian_;
  JointMotion joints_;
  JointVector steady_position_;  ///< position of joints_ without the vibration
  JointVector weight_, motion_;
  std::array<CylinderPosition, kMaxJoints> at_;

  void findResponse() noexcept;
  JointVector findWeightDeviation() const noexcept;
  JointMatrix findBending() const noexcept;
  double ownInertia(int link, int joint, int other) const noexcept;
  void storeResponse(Eigen::Index column, const JointVector& torque, const SteelLoads& load) noexcept;
  void arrangeResponse() noexcept;
  void computeDeviations(BoomDeviations& result) const noexcept;
  /// Columns: LoadErrors::Inputs. Rows: joint torques; force and moment of each section, then of each joint; forces of
  /// the cylinders on their base pins.
  Eigen::MatrixXd response_;
  Eigen::MatrixXd response_in_plane_;  ///< without inputs across the plane and the rows (half of all) that are then 0
  Eigen::VectorXi rows_in_plane_;      ///< indices of these rows, the first in_plane_ of them
  Eigen::Index in_plane_{};
  JointVector weight_std_;     ///< at response_at_
  JointMatrix bending_;        ///< at response_at_: torque of a joint per N m/s2 at the middle of a link [s2]
  JointVector response_at_;    ///< steady_position_ for which response_ was found; NaN before
  Eigen::VectorXd variance_;   ///< one entry per row of response_in_plane_
  Eigen::VectorXd deviation_;  ///< one entry per row of response_
  Eigen::Vector3d g_B_ = Eigen::Vector3d::Zero();
};

}  // namespace hammer_loads
