/// Hydraulic cylinder that holds a joint directly or through a bucket linkage: geometry, chambers, stiffness and
/// faults.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "hammer_loads/boom/bucket_linkage.h"
#include "hammer_loads/boom/chain.h"

namespace hammer_loads {

/// Lengths as in the boom file; each key is `NAME_` and the name beside the member.
struct CylinderParameters {
  std::string name;
  std::string joint;          ///< joint: the moving revolute joint that it spans
  double base_x{}, base_z{};  ///< base_x_m, base_z_m: anchor on the link before the joint, in its frame [m]
  double rod_x{}, rod_z{};    ///< rod_x_m, rod_z_m: anchor on the link beyond, in its frame [m]; with a linkage the
                              ///< coupler's pin on that link
  std::optional<BucketLinkageParameters> linkage{};  ///< linkage: bucket; empty: the rod ends on the link beyond
  double bore{};                                     ///< bore_m: diameter of the piston [m], > 0
  double rod_diameter{};                             ///< rod_diameter_m [m], > 0, < bore
  double closed_length{};     ///< closed_length_m: between the cylinder's pins, rod retracted [m], > stroke
  double stroke{};            ///< stroke_m [m], > 0
  double bore_hose_volume{};  ///< bore_hose_volume_m3: oil outside the piston's sweep, with the hose [m3], > 0
  double rod_hose_volume{};   ///< rod_hose_volume_m3 [m3], > 0
  double relief_pressure{};   ///< relief_pressure_Pa: highest pressure that the chambers hold [Pa], > 0
  /// Friction of the seals against the rod's motion: a constant part friction_force_N [N], and friction [-] times the
  /// oil's force; both >= 0.
  double friction_force{}, friction{};
  /// Standard deviations [N], [-]. NaN stands for kFrictionForceDeviation times the greatest push.
  double friction_force_std{std::numeric_limits<double>::quiet_NaN()}, friction_std{kFrictionDeviation};
  double stiffness_std{kStiffnessDeviation};  ///< standard deviation of its oil against the common one, relative [-]
  double joint_zero{}, joint_zero_std{};      ///< joint_zero_rad: sensor reading at the description's zero
  /// pressure_offset_Pa: offset of the bore's sensor with the effect of both chambers' offsets on the force [Pa].
  double pressure_offset{}, pressure_offset_std{};

  /// Defaults without keys in the boom file, as fractions of the greatest push and of the force. A loader crane's
  /// cylinders had a constant friction of 1 to 1.6 % of the push, and 3 to 6 % of a large force
  /// (doc/boom_calibration.md).
  static constexpr double kFrictionForceDeviation = 0.015, kFrictionDeviation = 0.03;
  static constexpr double kStiffnessDeviation = 0.1;  ///< default for air and hoses of one machine's cylinders [-]
  // Prior: kFrictionForceDeviation, kFrictionDeviation, kStiffnessDeviation
};

/// Length and leverage at a joint angle.
struct CylinderPosition {
  double length{};         ///< L between the cylinder's pins [m]
  double arm{};            ///< dL/dq [m]; positive: extending drives the joint forward
  double arm_rate{};       ///< d2L/dq2 [m]
  bool zero_moment_arm{};  ///< the arm is so short that no finite force holds the joint
  /// Positions (x, z) in a linkage, from the joint's origin in the axes of the link before [m]: the rod's pin, and the
  /// coupler's pin on the link beyond.
  Eigen::Vector2d rod_pin{0.0, 0.0}, driven_pin{0.0, 0.0};
};

/// Load of the cylinder. At a zero moment arm force and pressure are NaN.
struct CylinderForce {
  double force{};     ///< BY the cylinder ON both anchors [N], positive pushes them apart
  double pressure{};  ///< in the chamber that carries it, above the other chamber's, >= 0 [Pa]
  bool zero_moment_arm{};
};

/// Oil trapped beside the piston, hose included [m3].
struct OilVolumes {
  double bore{}, rod{};
};

/// Neglects: mass of the cylinder and its linkage, friction, flexibility of rod, links, pins and mounts, the tilt of a
/// link by its cylinder's own compression.
class Cylinder {
 public:
  /// Arms below this share of the shortest fixed side (joint to either anchor; of a linkage: joint to the coupler's
  /// pin, or the guide link) count as a zero moment arm, since the force would exceed 50 times the torque over that
  /// side.
  static constexpr double kZeroMomentArmRatio = 0.02;
  // Limit: kZeroMomentArmRatio

  /// Makes a cylinder or reports its problems, one line each, beginning with the key: signs, rod against bore, joint
  /// not in the chain, a linkage that does not close, and a geometry that needs the cylinder shorter than closed or
  /// longer than open within the joint's limits. bulk_modulus: of oil with hose and air [Pa].
  static Checked<Cylinder> make(const CylinderParameters& parameters, double bulk_modulus, const Chain& chain);

  const CylinderParameters& parameters() const noexcept { return parameters_; }
  const std::optional<BucketLinkage>& linkage() const noexcept { return linkage_; }
  int joint() const noexcept { return joint_; }  ///< index in the chain

  CylinderPosition at(double joint_angle) const noexcept;
  CylinderPosition at(double cosine, double sine) const noexcept;  ///< arguments: of the joint angle
  /// Returns the force that balances a load's torque on the joint [N m], by virtual work: force dL/dq = -torque.
  CylinderForce load(const CylinderPosition& position, double joint_torque) const noexcept;
  /// Returns dF/dL of the oil trapped in both chambers, B (Ab^2/Vb + Ar^2/Vr) [N/m]; beyond the stroke as at its end.
  double stiffness(double length) const noexcept;
  OilVolumes volumes(double length) const noexcept;  ///< beyond the stroke as at its end
  /// Returns the stiffness about the joint, stiffness times arm^2 [N m/rad]. It vanishes with the arm and involves no
  /// division. Neglects the pre-load's share, force times d2L/dq2.
  double jointStiffness(const CylinderPosition& position) const noexcept;

  double boreArea() const noexcept { return bore_area_; }                                    ///< pushes [m2]
  double rodArea() const noexcept { return rod_area_; }                                      ///< pulls [m2]
  double greatestPush() const noexcept { return parameters_.relief_pressure * bore_area_; }  ///< [N]
  double greatestPull() const noexcept { return parameters_.relief_pressure * rod_area_; }   ///< [N]

 private:
  Cylinder() = default;
  void findTriangle(const Chain& chain);
  void findLinkage(const Chain& chain, std::vector<std::string>& problems);
  void checkClosure(const Chain& chain, std::vector<std::string>& problems) const;
  /// Joint angle within the limits at which the length is farthest from what the stroke allows.
  struct Reach {
    double miss{}, angle{}, length{};  ///< [m], [rad], [m]
  };
  Reach worstReach(const Chain& chain) const;
  bool hasLimits(const Chain& chain, std::vector<std::string>& problems) const;
  void checkReach(const Chain& chain, std::vector<std::string>& problems) const;

  CylinderParameters parameters_;
  int joint_{};
  double bulk_modulus_{};
  double bore_area_{}, rod_area_{};
  std::optional<BucketLinkage> linkage_;
  double shorter_side_{};                ///< shortest fixed side, see kZeroMomentArmRatio [m]
  double steady_{}, cosine_{}, sine_{};  ///< L^2 = steady + cosine cos q + sine sin q [m2]
};

enum CylinderFlag : std::uint16_t {
  kChamberEmpty = 1,   ///< absolute pressure would be negative: the oil cavitates, the cylinder is softer than computed
  kForceReversed = 2,  ///< the force opposes the steady one, so that the pins cross their clearance
  kReliefReached = 4,  ///< a chamber reaches relief pressure, so that the valve opens and the joint yields
  kZeroMomentArm = 8,  ///< the cylinder does not hold the joint
};

/// Gauge pressures in both chambers of trapped oil [Pa].
struct ChamberPressures {
  double bore{}, rod{};
};

/// Returns both pressures; negative: the chamber runs empty. One chamber carries the steady load, the other has no
/// pressure. Both share quick changes in proportion to their oil's stiffness. Torques of the load on the joint [N m]:
/// steady (weight and slow motion) and total. Not valid at a zero moment arm.
ChamberPressures chamberPressures(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                                  double total_torque) noexcept;

/// Returns the force of measured pressures in both chambers [N]; positive pushes the anchors apart.
inline double forceOf(const Cylinder& cylinder, const ChamberPressures& p) noexcept {
  return p.bore * cylinder.boreArea() - p.rod * cylinder.rodArea();
}

/// Returns a sum of CylinderFlag. A chamber is empty below absolute zero, 1 bar below gauge zero.
std::uint16_t cylinderFlags(const Cylinder& cylinder, const CylinderPosition& position, double steady_torque,
                            double total_torque) noexcept;

}  // namespace hammer_loads
