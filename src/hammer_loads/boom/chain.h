/// The boom as a chain of rigid links, from a robot description.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/joint_space.h"
#include "hammer_loads/boom/robot_description.h"
#include "hammer_loads/util/checked.h"

namespace KDL {
class Chain;
}

namespace hammer_loads {

/// A link's body as weighed, in place of the description's; with what is fixed to it beside the chain.
struct WeighedLink {
  std::string name;
  double mass{};            ///< NAME_mass_kg [kg], > 0
  double com_x{}, com_z{};  ///< NAME_com_x_m, NAME_com_z_m: centre of mass in the link's frame [m]
  double inertia{};         ///< NAME_inertia_kg_m2: about the centre of mass, about the link's y [kg m2], > 0
  /// NAME_moment_x_std_kg_m, NAME_moment_z_std_kg_m: standard deviations of the first moment, in the link's
  /// frame about its joint, of all that the link carries, with the masses beyond the next joint in that joint [kg m].
  /// It is what weighing shows; mass and centre alone are known less.
  double moment_x_std{}, moment_z_std{};
};

/// By its name; null: not among them.
template <typename Links>
auto findLink(Links& links, const std::string& name) noexcept -> decltype(links.data()) {
  for (auto& link : links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

/// Part of the description that is the boom.
struct ChainRequest {
  std::string root{"base_link"};
  std::string tip{"hammer_hull"};
  std::vector<std::string> joints;     ///< joints that must move between root and tip
  bool massless{};                     ///< for directions alone: it need have no mass
  std::vector<WeighedLink> weighed{};  ///< links between root and tip whose bodies are not the description's
};

/// One line when the description can be read but does not have root or tip: it is that of another machine. Empty when
/// both are there, and when the text cannot be read, which Chain::make() reports.
std::string linksMissing(const RobotDescription& description, const ChainRequest& request);

/// From `base_link`, or the tree's root where that is not before them, over these joints to `hammer_hull`, or to the
/// last joint's link where that is not beyond them; for directions alone. Nothing where the description does not have
/// them one behind the other, or cannot be read.
std::optional<ChainRequest> chainOver(const RobotDescription& description, const std::vector<std::string>& joints);

/// A rigid body in a link's frame.
struct RigidBody {
  double mass{};                                      ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass [kg m2]
};

/// A link of the chain and how it hangs on the one before. With q its joint's position, in the frame P of the one
/// before: R_PL = steady + sin q sine + cos q cosine, p_PL = origin + q slide. The terms that a joint does not have are
/// zero.
struct ChainLink {
  std::string name;
  int joint{-1};  ///< index of its moving joint; -1: fixed
  bool prismatic{};
  Eigen::Matrix3d steady, sine, cosine;
  Eigen::Vector3d origin, slide;
  Eigen::Vector3d axis;  ///< axis of the joint in P; zero when fixed
  RigidBody body;        ///< with what is fixed to it beside the chain; of the root without inertia
};

/// A chain that can carry loads: at most kMaxJoints revolute or prismatic joints, mass beyond the last of them. Built
/// once; copies share the data, whose address stays (KDL's solvers keep a reference to the chain).
///
/// Bodies fixed to a chain link beside the chain count with that link. Bodies that move beside the chain do not:
/// a note names it. The mechanism's moving links belong to the hull's mass in the description, so that they count once.
class Chain {
 public:
  /// Every problem at once, one line each, beginning with `robot_description`: text that is no URDF, missing link, tip
  /// not beyond root, joint not in the chain, kind of joint, impossible mass or inertia.
  static Checked<Chain> make(const RobotDescription& description, const ChainRequest& request);

  int joints() const noexcept { return static_cast<int>(data_->joint_names.size()); }
  int links() const noexcept { return static_cast<int>(data_->links.size()); }  ///< root included
  const std::vector<std::string>& jointNames() const noexcept { return data_->joint_names; }
  const ChainLink& link(int index) const noexcept { return data_->links[static_cast<std::size_t>(index)]; }
  std::optional<int> jointIndex(const std::string& name) const noexcept;
  std::optional<int> linkIndex(const std::string& name) const noexcept;
  /// A link's body as it counts, deviations zero; index > 0.
  WeighedLink body(int index) const;
  int tip() const noexcept { return links() - 1; }
  /// Link beyond a joint; the one before has the index below it.
  int linkBeyond(int joint) const noexcept { return data_->link_beyond[static_cast<std::size_t>(joint)]; }

  const JointVector& lower() const noexcept { return data_->lower; }  ///< [rad], -infinity for a continuous joint
  const JointVector& upper() const noexcept { return data_->upper; }  ///< [rad]
  /// Chain in the form of KDL, fixed neighbours included in its inertias.
  const KDL::Chain& kdl() const noexcept { return *data_->kdl; }

 private:
  friend class ChainBuilder;
  struct Data {
    std::vector<ChainLink> links;  ///< [0] is the root
    std::vector<std::string> joint_names;
    std::vector<int> link_beyond;
    JointVector lower, upper;
    std::shared_ptr<KDL::Chain> kdl;
  };
  explicit Chain(std::shared_ptr<const Data> data) noexcept : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace hammer_loads
