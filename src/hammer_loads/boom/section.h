/// Section of a link of the chain, at which the internal load is computed.
#pragma once

#include <optional>
#include <string>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/boom/wrench.h"

namespace hammer_loads {

/// The part of a cut link that lies beyond the cut, in the link's frame.
struct PartBeyond {
  double mass{};                                  ///< mass_beyond_kg [kg], >= 0, at most the link's
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  ///< com_beyond_x_m, _y_m, _z_m [m]
  double inertia_y{};                             ///< inertia_beyond_kg_m2: about y through that point [kg m2], >= 0
};

/// Lengths in the boom file's terms; keys are `NAME_section_` and the names beside each member.
struct SectionParameters {
  std::string name;
  std::string link;                                  ///< link: between root_link and tip_link
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< x_m, y_m, z_m: origin of the cut in the link's frame [m]
  double pitch{};                                    ///< pitch_rad: the cut's axes are the link's, turned about y [rad]
  std::optional<PartBeyond> beyond;                  ///< nothing: the link counts as a uniform bar
};

/// A plane across a link, x normal to it and towards the hammer. The side x > 0 is beyond the cut.
///
/// Neglects: how the part beyond is spread across the link where only its inertia about y is known: it counts as a
/// slender bar along x, so about z as about y and nothing about x.
class Section {
 public:
  /// Problems, one line each, beginning with the key: the name, an unknown link, a plane that does not part the link's
  /// two joints, an origin far from the link, a part beyond that is more than the link. A note where the link counts as
  /// a uniform bar of its mass between its joints.
  static Checked<Section> make(const SectionParameters& parameters, const Chain& chain);

  const std::string& name() const noexcept { return parameters_.name; }
  const SectionParameters& parameters() const noexcept { return parameters_; }
  int link() const noexcept { return link_; }                ///< index in the chain
  const Pose& poseInLink() const noexcept { return X_LC_; }  ///< pose of the cut in its link
  const RigidBody& part() const noexcept { return part_; }   ///< part of the link beyond the cut, in the link's frame
  /// Returns true if a point of the link, in its frame, lies beyond the cut.
  bool beyond(const Eigen::Vector3d& p_L) const noexcept;

 private:
  Section() = default;
  SectionParameters parameters_;
  int link_{};
  Pose X_LC_ = Pose::Identity();
  RigidBody part_;
};

}  // namespace hammer_loads
