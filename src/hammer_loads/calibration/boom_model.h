/// Model of the pressures in a boom's cylinders in free movement, as a function of all unknowns.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/calibration/boom_recording.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::calibration {

/// Weight on the tip during one recording.
struct TipWeight {
  double mass{}, deviation{};  ///< [kg]; a deviation of zero: the mass is known
  double x{}, z{};             ///< centre of mass in the tip's frame [m]
};

/// Given parameters. Members with suffix _std are prior standard deviations of the quantities named beside them.
struct BoomBasis {
  RobotDescription urdf;
  BoomParameters parameters;
  Eigen::Vector3d g_B{0.0, 0.0, -kStandardGravity};  ///< gravity in the root's axes [m/s2]
  // Prior: mass_std, com_std, inertia_std, zero_std, offset_std, recording_std, recording_gain_std, gain_std,
  // friction_std, friction_force_std, viscous_std
  double mass_std{0.25};      ///< mass of each link, relative: nominal parameters lack hoses, oil, valves [-]
  double com_std{0.10};       ///< centre of mass of each link, in x and in z [m]
  double inertia_std{0.30};   ///< inertia of each link, relative [-]
  double zero_std{0.005};     ///< zero of each joint: 0.3 deg [rad]
  double offset_std{5e4};     ///< bore pressure: 0.2 % of a sensor for 25 MPa [Pa]
  double recording_std{5e4};  ///< difference of a bore pressure between recordings [Pa]
  double recording_gain_std{
      0.005};                 ///< relative difference of a cylinder's measured force from one recording to the next [-]
  double gain_std{0.005};     ///< cylinder force: bore within 0.1 mm, sensor gain [-]
  double friction_std{0.05};  ///< part of friction in proportion to the force [-]
  double friction_force_std{0.02};  ///< constant friction over the greatest push [-]
  double viscous_std{0.02};         ///< friction per speed over the greatest push: 0.2 % at 0.1 m/s [s/m]
};

/// Meaning of one entry of the vector of unknowns.
enum class BoomUnknown {
  kMass,           ///< logarithm of a link's mass over the description's [-]
  kComX,           ///< x of a link's centre of mass minus the description's [m]
  kComZ,           ///< z of a link's centre of mass minus the description's [m]
  kInertia,        ///< logarithm of a link's inertia about its centre of mass over the description's [-]
  kFrictionForce,  ///< constant friction of a cylinder [N]
  kFriction,       ///< friction of a cylinder over its force [-]
  kViscous,        ///< viscous friction of a cylinder [N s/m]
  kOffset,         ///< offset of a cylinder's bore pressure [Pa]
  kGain,           ///< gain of a cylinder's measured force minus one [-]
  kZero,           ///< zero of a cylinder's joint [rad]
  kTipWeight,      ///< weight on the tip in a recording [kg]
  kRecording,      ///< offset of a cylinder's bore pressure in one recording, in addition to kOffset [Pa]
};

/// Common properties of the unknowns of one kind.
struct UnknownKind {
  const char* name;  ///< suffix to the name of the link or cylinder: key in the boom file, or words
  const char* unit;
  const char* note;                ///< text of the report if this is no key of the boom file
  double WeighedLink::*of_link{};  ///< null: not a property of a link
  bool is_logarithm{};             ///< the link's given value is multiplied by the exponential of the unknown
  double CylinderParameters::*of_cylinder{};  ///< null: not a key of a cylinder
  double CylinderParameters::*std{};          ///< standard deviation of that key
};
const UnknownKind& kindOf(BoomUnknown unknown);

struct Unknown {
  BoomUnknown kind;
  std::size_t of;           ///< index of the recording or the cylinder (for a link: cylinder of its joint)
  double given{};           ///< value at which the entry of the vector is zero
  double deviation{};       ///< prior standard deviation
  std::size_t recording{};  ///< recording, for kRecording only
};

/// Boom as a function of its unknowns. Vectors x are in prior standard deviations; zero means the given values.
class BoomModel {
 public:
  /// Basis and weights (one per recording) must describe a boom that Boom::make() accepts.
  BoomModel(const BoomBasis& basis, const std::vector<TipWeight>& weights);

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns_.size())); }
  double valueOf(const Eigen::VectorXd& x, std::size_t unknown) const {
    const Unknown& u = unknowns_[unknown];
    return u.given + u.deviation * x[static_cast<Eigen::Index>(unknown)];
  }
  /// Returns a value by kind and index, or `otherwise` if it is not unknown. `recording` is for kRecording only.
  double valueOf(const Eigen::VectorXd& x, BoomUnknown kind, std::size_t of, double otherwise = kNaN,
                 std::size_t recording = 0) const;
  /// Returns the link that represents all links moving with a cylinder's joint: the heaviest one.
  int linkOf(std::size_t cylinder) const { return links_[cylinder]; }
  std::string nameOf(std::size_t unknown) const;

  /// Returns the boom without weights on the tip; empty for impossible values such as a negative mass.
  std::optional<Boom> boomAt(const Eigen::VectorXd& x) const;
  /// Returns the boom with the weight of a recording on its tip; empty for impossible values.
  std::optional<Boom> boomAt(const Eigen::VectorXd& x, std::size_t recording) const;
  /// Returns the first recording with the same known weight. Both recordings have the same boom.
  std::size_t firstWithWeightOf(std::size_t recording) const;
  /// Returns the boom file's parameters at x, without weights; deviations are those of the basis. Parts beyond sections
  /// are scaled with the mass of their links.
  BoomParameters parametersAt(const Eigen::VectorXd& x) const;
  /// Returns the zero of a cylinder's joint [rad].
  double jointZero(const Eigen::VectorXd& x, std::size_t cylinder) const;
  /// Moves the boom to the joint positions of a point, corrected by the joint zeros.
  void move(Boom& boom, const Eigen::VectorXd& x, const BoomPoint& point) const;
  /// Returns the force that a cylinder's pressures indicate [N], after move(). NaN at zero moment arm.
  double shownForce(const Boom& boom, const Eigen::VectorXd& x, std::size_t cylinder, std::size_t recording,
                    const BoomPoint& point) const;
  /// Returns the rod speed [m/s], positive while the rod extends.
  static double rodSpeed(const Boom& boom, std::size_t cylinder, const BoomPoint& point);
  /// Returns the force from the measured pressures, without corrections by the unknowns [N].
  double measuredForce(std::size_t cylinder, const BoomPoint& point) const;

  const BoomBasis& basis() const { return basis_; }
  const Boom& given() const { return given_; }

 private:
  std::vector<WeighedLink> linksAt(const Eigen::VectorXd& x) const;  ///< bodies of the links in links_
  /// Returns all links that have weighed values in the boom file or are unknowns.
  std::vector<WeighedLink> weighedAt(const Eigen::VectorXd& x) const;

  BoomBasis basis_;
  std::vector<TipWeight> weights_;
  Boom given_;
  std::vector<int> links_;
  std::vector<Unknown> unknowns_;
};

/// Returns the torques of weight about the joints of all cylinders, pose by pose [N m]. Poses are joint readings. All
/// values are NaN if x gives no valid boom.
Eigen::VectorXd weightTorques(const BoomModel& model, const Eigen::VectorXd& x, const std::vector<JointVector>& poses);

}  // namespace hammer_loads::calibration
