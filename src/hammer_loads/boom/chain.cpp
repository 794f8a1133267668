#include "hammer_loads/boom/chain.h"

#include <algorithm>
#include <kdl/tree.hpp>
#include <set>
#include <utility>

#include "hammer_loads/boom/figure_limits.h"
#include "hammer_loads/boom/urdf_tree.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// Least mass [kg] and inertia [kg m2] of an identified link; largest standard deviation of its first moment [kg m].
constexpr double kLeastMass = 1e-9, kMostMoment = figure::kMostMass * figure::kMostLength;
// Limit: kLeastMass, kMostMoment

bool moves(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

Eigen::Vector3d toEigen(const KDL::Vector& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Matrix3d toEigen(const KDL::Rotation& R) {
  Eigen::Matrix3d M;
  M << R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2);
  return M;
}

RigidBody toEigen(KDL::RigidBodyInertia body) {  // its RefPoint() is not const
  const KDL::RotationalInertia about_com = body.RefPoint(body.getCOG()).getRotationalInertia();
  return {body.getMass(), toEigen(body.getCOG()),
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(about_com.data)};
}

/// Returns position and rotation of a segment as functions of its joint.
ChainLink toLink(const KDL::Segment& segment) {
  ChainLink link;
  link.name = segment.getName();
  const KDL::Frame rest = segment.pose(0.0);
  const Eigen::Matrix3d R = toEigen(rest.M);
  link.origin = toEigen(rest.p);
  link.steady = R;
  link.sine = link.cosine = Eigen::Matrix3d::Zero();
  link.slide = link.axis = Eigen::Vector3d::Zero();
  link.body = toEigen(segment.getInertia());
  // Both KDL 1.4 and KDL 1.5 name a fixed joint None.
  const KDL::Joint::JointType type = segment.getJoint().getType();
  if (type == KDL::Joint::None) return link;
  link.axis = toEigen(segment.getJoint().JointAxis());
  link.prismatic = type == KDL::Joint::TransAxis;
  if (link.prismatic) {
    link.slide = link.axis;
    return link;
  }
  // Rodrigues: Rot(a, q) = (I + K^2) + sin q K - cos q K^2 with K = [a]x.
  Eigen::Matrix3d K;
  K << 0.0, -link.axis.z(), link.axis.y(), link.axis.z(), 0.0, -link.axis.x(), -link.axis.y(), link.axis.x(), 0.0;
  link.steady = R + K * K * R;
  link.sine = K * R;
  link.cosine = -K * K * R;
  return link;
}

bool isBefore(const std::string& name, urdf::LinkConstSharedPtr link) {
  while (link && link->name != name) link = link->getParent();
  return link != nullptr;
}

}  // namespace

/// Collects the chain's data and all problems of it.
class ChainBuilder {
 public:
  ChainBuilder(const urdf::ModelInterface& model, const ChainRequest& request, Checked<Chain>& result)
      : model_(model), request_(request), result_(result) {
    data_.kdl = std::make_shared<KDL::Chain>();
  }

  void build() {
    if (findPath()) {
      checkJoints();
      checkWeighed();
    }
    if (!result_.problems.empty()) return;
    tree_ = treeOf(model_);
    addLinks();
    if (!request_.massless) checkMassBeyondJoints();
    if (!result_.problems.empty()) return;
    result_.value = Chain(std::make_shared<const Chain::Data>(std::move(data_)));
  }

 private:
  bool findPath() {
    bool found = true;
    for (const std::string& name : {request_.root, request_.tip}) {
      if (model_.getLink(name)) continue;
      result_.problems.push_back(format("robot_description: link %s: not in the model, is required", name.c_str()));
      found = false;
    }
    if (!found) return false;
    urdf::LinkConstSharedPtr link = model_.getLink(request_.tip);
    while (link->name != request_.root && link->parent_joint) {
      path_.push_back(link->parent_joint);
      link = link->getParent();
    }
    std::reverse(path_.begin(), path_.end());
    if (link->name == request_.root) return true;
    result_.problems.push_back(format("robot_description: link %s: hangs on %s, must hang on %s", request_.tip.c_str(),
                                      link->name.c_str(), request_.root.c_str()));
    return false;
  }

  void checkJoints() {
    std::set<std::string> moving;
    for (const urdf::JointConstSharedPtr& joint : path_) {
      if (moves(*joint)) moving.insert(joint->name);
      if (!moves(*joint) && joint->type != urdf::Joint::FIXED) {
        result_.problems.push_back(
            format("robot_description: joint %s: must be revolute, continuous, prismatic or "
                   "fixed",
                   joint->name.c_str()));
      }
      if (joint->mimic) {
        result_.problems.push_back(format("robot_description: joint %s: mimics %s, must move by itself",
                                          joint->name.c_str(), joint->mimic->joint_name.c_str()));
      }
    }
    const auto count = static_cast<int>(moving.size());
    if (count < 1 || count > kMaxJoints || static_cast<int>(path_.size()) >= kMaxLinks) {
      result_.problems.push_back(
          format("robot_description: %d moving joints and %d links from %s to %s, must be 1 to "
                 "%d joints and at most %d links",
                 count, static_cast<int>(path_.size()) + 1, request_.root.c_str(), request_.tip.c_str(), kMaxJoints,
                 kMaxLinks));
    }
    for (const std::string& name : request_.joints) {
      if (moving.count(name) != 0) continue;
      const char* why = model_.getJoint(name) ? "not a moving joint" : "not in the model, must be a moving joint";
      result_.problems.push_back(format("robot_description: joint %s: %s between %s and %s", name.c_str(), why,
                                        request_.root.c_str(), request_.tip.c_str()));
    }
  }

  void checkWeighed() {
    std::set<std::string> there, named;
    for (const urdf::JointConstSharedPtr& joint : path_) there.insert(joint->child_link_name);
    for (const WeighedLink& w : request_.weighed) {
      const auto refuse = [&](const std::string& why) { result_.problems.push_back("weighed_links: " + w.name + why); };
      if (!named.insert(w.name).second) refuse(", given twice, must be different links");
      if (there.count(w.name) == 0)
        refuse(format(", must be a link between %s and %s", request_.root.c_str(), request_.tip.c_str()));
      const auto check = [&](const char* key, double value, const char* unit, double least, double most) {
        checkRange(w.name + "_" + key, value, unit, least, most, result_.problems);
      };
      check("mass_kg", w.mass, "kg", kLeastMass, figure::kMostMass);
      check("com_x_m", w.com_x, "m", -figure::kMostLength, figure::kMostLength);
      check("com_z_m", w.com_z, "m", -figure::kMostLength, figure::kMostLength);
      check("inertia_kg_m2", w.inertia, "kg m2", kLeastMass, figure::kMostMass);
      check("moment_x_std_kg_m", w.moment_x_std, "kg m", 0.0, kMostMoment);
      check("moment_z_std_kg_m", w.moment_z_std, "kg m", 0.0, kMostMoment);
    }
  }

  /// Returns the identified body of a link if there is one. Inertias about other axes scale with the one about y.
  KDL::RigidBodyInertia asWeighed(const std::string& name, KDL::RigidBodyInertia described) const {
    const WeighedLink* found = findLink(request_.weighed, name);
    if (found == nullptr) return described;
    const KDL::RotationalInertia about_com = described.RefPoint(described.getCOG()).getRotationalInertia();
    const double about_y = about_com.data[4];
    const KDL::Vector com(found->com_x, described.getCOG().y(), found->com_z);
    const KDL::RotationalInertia inertia = about_y > 0.0
                                               ? KDL::operator*(found->inertia / about_y, about_com)
                                               : KDL::RotationalInertia(found->inertia, found->inertia, found->inertia);
    return KDL::RigidBodyInertia(found->mass, com, inertia);
  }

  void addLinks() {
    for (const urdf::JointConstSharedPtr& joint : path_) in_chain_.insert(joint->child_link_name);
    in_chain_.insert(request_.root);
    const auto root = tree_.getSegment(request_.root);
    ChainLink base = toLink(KDL::Segment(request_.root));
    base.body = toEigen(ownBody(*model_.getLink(request_.root)) + fixedNeighbours(root));
    data_.links.push_back(std::move(base));
    data_.lower.resize(0), data_.upper.resize(0);
    for (const urdf::JointConstSharedPtr& joint : path_) addLink(*joint);
  }

  void addLink(const urdf::Joint& joint) {
    const auto element = tree_.getSegment(joint.child_link_name);
    const KDL::Segment& bare = GetTreeElementSegment(element->second);
    data_.kdl->addSegment(KDL::Segment(bare.getName(), bare.getJoint(), bare.getFrameToTip(),
                                       asWeighed(bare.getName(), bare.getInertia() + fixedNeighbours(element))));
    ChainLink link = toLink(data_.kdl->segments.back());
    if (moves(joint)) {
      link.joint = static_cast<int>(data_.joint_names.size());
      data_.joint_names.push_back(joint.name);
      data_.link_beyond.push_back(static_cast<int>(data_.links.size()));
      const bool limited = joint.type != urdf::Joint::CONTINUOUS && joint.limits;
      data_.lower.conservativeResize(link.joint + 1);
      data_.upper.conservativeResize(link.joint + 1);
      data_.lower[link.joint] = limited ? joint.limits->lower : -kInfinity;
      data_.upper[link.joint] = limited ? joint.limits->upper : kInfinity;
    }
    data_.links.push_back(link);
  }

  /// Returns mass and centre of the root. KDL gives the tree's root no inertia, but its mass holds the machine down.
  static KDL::RigidBodyInertia ownBody(const urdf::Link& link) {
    if (!link.inertial) return KDL::RigidBodyInertia::Zero();
    const urdf::Vector3& p = link.inertial->origin.position;
    return KDL::RigidBodyInertia(link.inertial->mass, KDL::Vector(p.x, p.y, p.z));
  }

  /// Returns the sum of the bodies on a link by fixed joints beside the chain, in the link's frame.
  KDL::RigidBodyInertia fixedNeighbours(const KDL::SegmentMap::const_iterator& element) {
    KDL::RigidBodyInertia sum = KDL::RigidBodyInertia::Zero();
    for (const KDL::SegmentMap::const_iterator& child : GetTreeElementChildren(element->second)) {
      const KDL::Segment& segment = GetTreeElementSegment(child->second);
      if (in_chain_.count(segment.getName()) != 0) continue;
      const KDL::RigidBodyInertia body = segment.getInertia() + fixedNeighbours(child);
      if (segment.getJoint().getType() == KDL::Joint::None) {
        sum = sum + segment.pose(0.0) * body;
      } else if (body.getMass() > 0.0) {
        result_.notes.push_back(format("robot_description: link %s: %.6g kg move beside the chain and are not counted",
                                       segment.getName().c_str(), body.getMass()));
      }
    }
    return sum;
  }

  /// Checks the mass beyond the last joint. A regular mass matrix needs it, and at rest inertia about revolute axes.
  void checkMassBeyondJoints() {
    const int last = data_.link_beyond.back();
    double mass = 0.0;
    for (auto i = static_cast<std::size_t>(last); i < data_.links.size(); ++i) mass += data_.links[i].body.mass;
    if (mass > 0.0) return;
    result_.problems.push_back(format("robot_description: mass beyond joint %s: %.6g kg, must be > 0",
                                      data_.joint_names.back().c_str(), mass));
  }

  const urdf::ModelInterface& model_;
  const ChainRequest& request_;
  Checked<Chain>& result_;
  std::vector<urdf::JointConstSharedPtr> path_;
  std::set<std::string> in_chain_;
  KDL::Tree tree_;
  Chain::Data data_;
};

std::string linksMissing(const RobotDescription& description, const ChainRequest& request) {
  const urdf::ModelInterface* model = description.model();
  if (model == nullptr) return {};
  for (const std::string& name : {request.root, request.tip}) {
    if (!model->getLink(name)) return "robot_description: has no link " + name;
  }
  return {};
}

std::optional<ChainRequest> chainOver(const RobotDescription& description, const std::vector<std::string>& joints) {
  const urdf::ModelInterface* model = description.model();
  if (model == nullptr) return std::nullopt;
  for (const std::string& name : joints) {
    const urdf::JointConstSharedPtr joint = model->getJoint(name);
    if (!joint) return std::nullopt;
    // The last joint has all the others before it.
    std::size_t met = 0;
    std::string first;  // link before the first joint
    for (urdf::LinkConstSharedPtr link = model->getLink(joint->child_link_name); link->parent_joint;
         link = link->getParent()) {
      const auto times = std::count(joints.begin(), joints.end(), link->parent_joint->name);
      if (times > 0) first = link->parent_joint->parent_link_name;
      met += static_cast<std::size_t>(times);
    }
    if (met != joints.size()) continue;
    ChainRequest request;
    const urdf::LinkConstSharedPtr hull = model->getLink(request.tip);
    if (!hull || !isBefore(joint->child_link_name, hull)) request.tip = joint->child_link_name;
    if (!isBefore(request.root, model->getLink(first))) request.root = model->getRoot()->name;
    request.joints = joints;
    request.massless = true;
    return request;
  }
  return std::nullopt;
}

Checked<Chain> Chain::make(const RobotDescription& description, const ChainRequest& request) {
  Checked<Chain> result;
  result.problems = description.problems();
  if (description.model() != nullptr) ChainBuilder(*description.model(), request, result).build();
  return result;
}

std::optional<int> Chain::jointIndex(const std::string& name) const noexcept {
  const auto found = std::find(data_->joint_names.begin(), data_->joint_names.end(), name);
  if (found == data_->joint_names.end()) return std::nullopt;
  return static_cast<int>(found - data_->joint_names.begin());
}

WeighedLink Chain::body(int index) const {
  const RigidBody& body = link(index).body;
  return {link(index).name, body.mass, body.com.x(), body.com.z(), body.inertia(1, 1), 0.0, 0.0};
}

std::optional<int> Chain::linkIndex(const std::string& name) const noexcept {
  for (int i = 0; i < links(); ++i) {
    if (link(i).name == name) return i;
  }
  return std::nullopt;
}

}  // namespace hammer_loads
