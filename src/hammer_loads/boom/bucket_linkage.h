/// Four-bar linkage between the rod of a cylinder and the link that it moves, as on buckets and most hammers.
#pragma once

#include <Eigen/Core>

namespace hammer_loads {

/// Lengths as in the boom file; each key is `NAME_` and the name beside the member. The rod's pin is common to guide
/// link and coupler. The guide link turns about a pivot on the link that carries the cylinder; the coupler ends on the
/// driven link.
struct BucketLinkageParameters {
  double guide_x{}, guide_z{};  ///< rocker_link_base_x_m, _z_m: pivot of the guide link, on the link before [m]
  double guide_length{};        ///< rocker_link_length_m: from that pivot to the common pin [m], > 0
  double coupler_length{};      ///< coupler_length_m: from the common pin to the driven link [m], > 0
  /// linkage_branch: sign about +y of the rotation from the line between guide pivot and driven pin to the guide link,
  /// 1 or -1. With 0 the stroke decides.
  double branch{};
};

/// State of the linkage at one angle. Positions (x, z) are from the joint's axis, in the axes of the link before.
struct BucketLinkagePosition {
  bool closed{};               ///< guide and coupler meet; otherwise they are placed in line
  double length{};             ///< length of the cylinder, between its pins [m]
  double arm{}, arm_rate{};    ///< dL/dq [m/rad] and d2L/dq2 [m/rad2]; zero where it is not closed
  Eigen::Vector2d rod_pin;     ///< the common pin [m]
  Eigen::Vector2d driven_pin;  ///< pin of the coupler on the driven link [m]
};

/// Forces of the three links on the common pin per unit force of the rod, along the links. A positive rod force pushes.
struct BucketLinkageForces {
  Eigen::Vector2d rod;      ///< unit vector, from the cylinder's base [-]
  Eigen::Vector2d guide;    ///< [-]
  Eigen::Vector2d coupler;  ///< [-]
};

/// Closed-form kinematics and statics. Neglects mass, joint clearance and elasticity of the links.
class BucketLinkage {
 public:
  /// Least angle by which guide and coupler differ from being in line within the joint's limits: 5 deg [rad].
  static constexpr double kLeastTransmission = 0.087;
  // Limit: kLeastTransmission (FigureLimits.OfTransmissionAngles)

  /// Positions of the pins from the joint's axis, in the axes of the link before [m]: base of the cylinder, guide
  /// pivot, and driven pin at joint angle zero. sense: 1 where the joint turns about +y, -1 about -y.
  struct Pins {
    Eigen::Vector2d base, guide, driven;
    double sense{1.0};
  };
  BucketLinkage(const Pins& pins, const BucketLinkageParameters& lengths) noexcept;

  BucketLinkagePosition at(double cosine, double sine) const noexcept;  ///< arguments: of the joint angle
  BucketLinkageForces forces(const Eigen::Vector2d& rod_pin, const Eigen::Vector2d& driven_pin) const noexcept;
  /// Least and greatest distance of guide pivot and driven pin that keep kLeastTransmission [m].
  double leastReach() const noexcept { return least_reach_; }
  double mostReach() const noexcept { return most_reach_; }
  double reach(const BucketLinkagePosition& position) const noexcept {
    return (position.driven_pin - pins_.guide).norm();
  }

 private:
  Pins pins_;
  double guide_, coupler_, branch_;
  double least_reach_, most_reach_;
};

}  // namespace hammer_loads
