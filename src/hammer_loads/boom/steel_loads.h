/// Loads of the boom's steel: loads of its sections, reactions of its joints, forces of its cylinders' pins.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/boom/chain_dynamics.h"
#include "hammer_loads/boom/cylinder.h"
#include "hammer_loads/boom/section.h"

namespace hammer_loads {

constexpr int kMaxSections = 32;

/// Forces of a cylinder and its linkage ON the links that they join [N].
struct PinForces3d {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();   ///< by the cylinder on the link before, in its axes
  Eigen::Vector3d guide = Eigen::Vector3d::Zero();  ///< by the guide link on the link before, in its axes; or none
  Eigen::Vector3d rod = Eigen::Vector3d::Zero();    ///< by the rod or the coupler on the link beyond, in its axes
};

/// Section loads and joint reactions. Where a cylinder has a zero moment arm, everything that it carries is NaN: its
/// pins, the reaction of its joint, and the sections that it crosses.
struct SteelLoads {
  /// BY everything beyond the cut, towards the hammer, ON what lies before it, about the cut's origin, axes of the cut.
  std::array<Wrench, kMaxSections> section;
  /// BY the link beyond ON the link before at the joint's origin, axes of the link before; without what the joint's
  /// cylinder takes. No moment about the axis of a revolute joint with a cylinder; that of a held joint is its total
  /// torque.
  std::array<Wrench, kMaxJoints> joint;
  std::array<PinForces3d, kMaxJoints> pins;  ///< index as the cylinders
};

/// Accelerations and loads that the chain has at one instant.
struct ChainState {
  const ChainPose& pose;
  const ChainLoads& links;            ///< loads of weight and motion, the vibration's included
  const Wrench& w_tip;                ///< BY the hammer ON the tip, as for Boom::loads()
  const CylinderPosition* cylinders;  ///< position of each cylinder
};

/// The load of everything beyond each cut. A cylinder's force is the one that leaves no moment about its joint's axis,
/// so a section is the same from either side. Made once; no allocation later.
///
/// Neglects: what Cylinder and Section neglect; coupling of vibration and slow motion.
class SteelLoadFinder {
 public:
  SteelLoadFinder(const Chain& chain, const std::vector<Cylinder>& cylinders, std::vector<Section> sections);

  /// False: the state is so large that results are not finite and must not be used.
  bool find(const ChainState& state, SteelLoads& result) const noexcept;
  const std::vector<Section>& sections() const noexcept { return sections_; }

 private:
  /// A cylinder with its pins on the two links of a joint.
  struct Anchors {
    Cylinder cylinder;
    int beyond{};                            ///< link of the rod's pin; the others are on the one before
    Eigen::Vector3d base_P, guide_P, rod_L;  ///< in the frames of the two links [m]
  };
  enum Pin { kBase, kGuide, kRod, kPins };
  /// A pin whose force acts on what lies beyond a section, of a cylinder that has others before it.
  struct Crossing {
    std::size_t cylinder{};
    Pin pin{};
  };
  std::vector<Crossing> crossing(const Section& section) const;
  /// In the root's frame, moments about its origin.
  struct Working;

  bool addHammer(const ChainState& state, Working& working) const noexcept;
  void findCylinders(const ChainState& state, Working& working, SteelLoads& result) const noexcept;
  void findJoints(const ChainState& state, const Working& working, SteelLoads& result) const noexcept;
  void findSections(const ChainState& state, const Working& working, SteelLoads& result) const noexcept;

  Chain chain_;
  std::vector<Anchors> anchors_;
  std::vector<Section> sections_;
  std::vector<std::vector<Crossing>> crossing_;  ///< per section
};

}  // namespace hammer_loads
