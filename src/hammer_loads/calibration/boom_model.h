/// Model of the pressures in a boom's cylinders in free movement, as a function of all unknowns.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/calibration/boom_recording.h"
#include "hammer_loads/util/constants.h"

namespace hammer_loads::calibration {

/// A weight that hangs on the tip in one recording.
struct TipWeight {
  double mass{}, deviation{};  ///< [kg]; a deviation of zero: it is known
  double x{}, z{};             ///< centre of mass in the tip's frame [m]
};

/// Given parameters and their standard deviations.
struct BoomBasis {
  RobotDescription urdf;
  BoomParameters parameters;
  Eigen::Vector3d g_B{0.0, 0.0, -kStandardGravity};  ///< gravity in the root's axes [m/s2]
  // Prior: mass_std, com_std, inertia_std, zero_std, offset_std, recording_std, recording_gain_std, gain_std,
  // friction_std, friction_force_std, viscous_std
  double mass_std{0.25};      ///< standard, of each link's mass, relative: drawings lack hoses, oil, valves [-]
  double com_std{0.10};       ///< standard, of each link's centre of mass in x and z each [m]
  double inertia_std{0.30};   ///< standard, of each link's inertia, relative [-]
  double zero_std{0.005};     ///< standard, of each joint's zero: 0.3 deg [rad]
  double offset_std{5e4};     ///< standard, of a bore's pressure: 0.2 % of a sensor for 25 MPa [Pa]
  double recording_std{5e4};  ///< by which a bore's pressure differs from one recording to the next [Pa]
  double recording_gain_std{
      0.005};                       ///< standard, by which a force differs from one recording to the next, relative [-]
  double gain_std{0.005};           ///< standard, of a cylinder's force: bore within 0.1 mm, sensor's gain [-]
  double friction_std{0.05};        ///< standard, of the part of friction that goes with the force [-]
  double friction_force_std{0.02};  ///< standard, of the constant part, over the greatest push [-]
  double viscous_std{0.02};         ///< standard, of friction per speed, over the greatest push: 0.2 % at 0.1 m/s [s/m]
};

/// Meaning of one entry of the vector of unknowns.
enum class BoomUnknown {
  kMass,           ///< mass of a link, logarithm of it over the description's [-]
  kComX,           ///< x of a link's centre of mass, less the description's [m]
  kComZ,           ///< z of a link's centre of mass, less the description's [m]
  kInertia,        ///< inertia of a link about its centre of mass, logarithm of it over the description's [-]
  kFrictionForce,  ///< constant friction of a cylinder [N]
  kFriction,       ///< friction of a cylinder, over its force [-]
  kViscous,        ///< viscous friction of a cylinder [N s/m]
  kOffset,         ///< offset of a cylinder's bore pressure [Pa]
  kGain,           ///< gain of a cylinder's measured force, less one [-]
  kZero,           ///< zero of a cylinder's joint [rad]
  kTipWeight,      ///< weight on the tip in a recording [kg]
  kRecording,      ///< offset of a cylinder's bore pressure in one recording, beside kOffset [Pa]
};

/// Common properties of the unknowns of one kind.
struct UnknownKind {
  const char* name;  ///< key in the boom file, or words, behind the name of its link or cylinder
  const char* unit;
  const char* note;                           ///< words of the report, where it is no key of the boom file
  double WeighedLink::*of_link{};             ///< null: not of a link
  bool is_logarithm{};                        ///< the link's given value is multiplied by its exponential
  double CylinderParameters::*of_cylinder{};  ///< null: no key of a cylinder
  double CylinderParameters::*std{};          ///< standard deviation of that
};
const UnknownKind& kindOf(BoomUnknown unknown);

struct Unknown {
  BoomUnknown kind;
  std::size_t of;           ///< index of cylinder (links: of the cylinder whose joint they hang on) or recording
  double given{};           ///< the value at which its entry is zero
  double deviation{};       ///< standard, before the recording
  std::size_t recording{};  ///< recording of a kRecording
};

/// A boom with the unknowns at some values. Entries of the vector are in their standard deviations, zero as given.
class BoomModel {
 public:
  /// Basis and weights (one per recording) are those of a boom that Boom::make() accepts.
  BoomModel(const BoomBasis& basis, const std::vector<TipWeight>& weights);

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns_.size())); }
  double valueOf(const Eigen::VectorXd& x, std::size_t unknown) const {
    const Unknown& u = unknowns_[unknown];
    return u.given + u.deviation * x[static_cast<Eigen::Index>(unknown)];
  }
  /// By kind and index; `otherwise` where it is none of the unknowns. recording: of a kRecording.
  double valueOf(const Eigen::VectorXd& x, BoomUnknown kind, std::size_t of, double otherwise = kNaN,
                 std::size_t recording = 0) const;
  /// The link of the chain that stands for all that moves with a cylinder's joint: the heaviest.
  int linkOf(std::size_t cylinder) const { return links_[cylinder]; }
  std::string nameOf(std::size_t unknown) const;

  /// Boom without weights on the tip; empty for impossible values such as a negative mass.
  std::optional<Boom> boomAt(const Eigen::VectorXd& x) const;
  /// Boom with the weight of a recording on its tip; empty for impossible values.
  std::optional<Boom> boomAt(const Eigen::VectorXd& x, std::size_t recording) const;
  /// The first recording whose weight is known to be the same. Both recordings have the same boom.
  std::size_t firstWithWeightOf(std::size_t recording) const;
  /// Boom file with these values, weights left out; deviations as in the basis. Parts beyond sections are as much
  /// heavier as their links.
  BoomParameters parametersAt(const Eigen::VectorXd& x) const;
  /// Zero of a cylinder's joint [rad].
  double jointZero(const Eigen::VectorXd& x, std::size_t cylinder) const;
  /// Puts the boom where the joints are at a point, zeros allowed for.
  void move(Boom& boom, const Eigen::VectorXd& x, const BoomPoint& point) const;
  /// After that: force that the cylinder's pressures show in a recording [N]. NaN at a dead centre.
  double shownForce(const Boom& boom, const Eigen::VectorXd& x, std::size_t cylinder, std::size_t recording,
                    const BoomPoint& point) const;
  /// The rod's speed [m/s]: positive as it comes out.
  static double rodSpeed(const Boom& boom, std::size_t cylinder, const BoomPoint& point);
  /// Force by the measured pressures as given, without the effect of the unknowns on it [N].
  double measuredForce(std::size_t cylinder, const BoomPoint& point) const;

  const BoomBasis& basis() const { return basis_; }
  const Boom& given() const { return given_; }

 private:
  std::vector<WeighedLink> linksAt(const Eigen::VectorXd& x) const;  ///< bodies of the links in links_
  /// All links that are weighed in the boom file or are unknowns.
  std::vector<WeighedLink> weighedAt(const Eigen::VectorXd& x) const;

  BoomBasis basis_;
  std::vector<TipWeight> weights_;
  Boom given_;
  std::vector<int> links_;
  std::vector<Unknown> unknowns_;
};

/// Weight's torques on the joints of all cylinders at the first pose, then at the next ones, joints as read [N m]; NaN
/// where x makes no boom.
Eigen::VectorXd weightTorques(const BoomModel& model, const Eigen::VectorXd& x, const std::vector<JointVector>& poses);

}  // namespace hammer_loads::calibration
