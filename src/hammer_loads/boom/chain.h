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

/// Identified body of a link, instead of the description's. It includes the parts fixed to the link beside the chain.
struct WeighedLink {
  std::string name;
  double mass{};            ///< NAME_mass_kg [kg], > 0
  double com_x{}, com_z{};  ///< NAME_com_x_m, NAME_com_z_m: centre of mass in the link's frame [m]
  double inertia{};         ///< NAME_inertia_kg_m2: about the centre of mass, about the link's y [kg m2], > 0
  /// NAME_moment_x_std_kg_m, NAME_moment_z_std_kg_m: standard deviations of the first moment of all that the link
  /// carries, in its frame about its joint [kg m]. Masses beyond the next joint count as placed there. Identification
  /// determines this moment; mass and centre alone are less certain.
  double moment_x_std{}, moment_z_std{};
};

/// Returns the link of that name, or null.
template <typename Links>
auto findLink(Links& links, const std::string& name) noexcept -> decltype(links.data()) {
  for (auto& link : links) {
    if (link.name == name) return &link;
  }
  return nullptr;
}

/// Selects the boom within a robot description.
struct ChainRequest {
  std::string root{"base_link"};
  std::string tip{"hammer_hull"};
  std::vector<std::string> joints;     ///< joints that must move between root and tip
  bool massless{};                     ///< for directions alone, so that mass is not required
  std::vector<WeighedLink> weighed{};  ///< identified bodies of links between root and tip
};

/// Returns one line if a readable description lacks root or tip, being that of another machine. Returns an empty string
/// if both exist, or if the text cannot be read, which Chain::make() reports.
std::string linksMissing(const RobotDescription& description, const ChainRequest& request);

/// Returns a chain over these joints, for directions alone. It begins at `base_link` if that is before them, else at
/// the tree's root. It ends at `hammer_hull` if that is beyond them, else at the last joint's link. Empty where the
/// joints are not in series or the description cannot be read.
std::optional<ChainRequest> chainOver(const RobotDescription& description, const std::vector<std::string>& joints);

/// A rigid body in a link's frame.
struct RigidBody {
  double mass{};                                      ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass [kg m2]
};

/// Link of the chain and its pose on the previous link. With q the position of its joint and P the frame of the
/// previous link: R_PL = steady + sin q sine + cos q cosine, p_PL = origin + q slide. Terms that do not apply to the
/// joint are zero.
struct ChainLink {
  std::string name;
  int joint{-1};  ///< index of its moving joint; -1: fixed
  bool prismatic{};
  Eigen::Matrix3d steady, sine, cosine;
  Eigen::Vector3d origin, slide;
  Eigen::Vector3d axis;  ///< axis of the joint in P; zero when fixed
  RigidBody body;        ///< with the parts fixed to it beside the chain; the root's has no own inertia
};

/// Chain with at most kMaxJoints revolute or prismatic joints and mass beyond the last one. It is built once. Copies
/// share the data, whose address stays, because KDL's solvers keep a reference to the chain.
///
/// Bodies fixed to a chain link beside the chain count with that link. Bodies that move beside the chain do not; a note
/// names them. The mechanism's moving links belong to the hull's mass in the description, so that they count once.
class Chain {
 public:
  /// Makes a chain or reports every problem, one line each, beginning with `robot_description`: text that is no URDF,
  /// missing link, tip not beyond root, joint not in the chain, kind of joint, impossible mass or inertia.
  static Checked<Chain> make(const RobotDescription& description, const ChainRequest& request);

  int joints() const noexcept { return static_cast<int>(data_->joint_names.size()); }
  int links() const noexcept { return static_cast<int>(data_->links.size()); }  ///< root included
  const std::vector<std::string>& jointNames() const noexcept { return data_->joint_names; }
  const ChainLink& link(int index) const noexcept { return data_->links[static_cast<std::size_t>(index)]; }
  std::optional<int> jointIndex(const std::string& name) const noexcept;
  std::optional<int> linkIndex(const std::string& name) const noexcept;
  /// Returns the body of a link in use, with zero standard deviations; index > 0.
  WeighedLink body(int index) const;
  int tip() const noexcept { return links() - 1; }
  /// Returns the index of the link beyond a joint. The link before the joint has the next lower index.
  int linkBeyond(int joint) const noexcept { return data_->link_beyond[static_cast<std::size_t>(joint)]; }

  const JointVector& lower() const noexcept { return data_->lower; }  ///< [rad], -infinity for a continuous joint
  const JointVector& upper() const noexcept { return data_->upper; }  ///< [rad]
  /// Returns the chain as KDL's type; its inertias include fixed neighbours.
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
