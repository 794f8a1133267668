#include "hammer_loads/boom/steel_loads.h"

#include <utility>

namespace hammer_loads {
namespace {

/// No product of it with lengths and levers of a chain that could be built overflows [N], [N m].
constexpr double kMostLoad = 1e200;

/// How a link moves in the root's axes; the root accelerates against gravity, which stands for the weight.
struct LinkState {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                  ///< [rad/s]
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< [rad/s2]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< of its origin less gravity [m/s2]

  Eigen::Vector3d accelerationAt(const Eigen::Vector3d& r) const noexcept {
    return acceleration + angular_acceleration.cross(r) + rate.cross(rate.cross(r));
  }
};

/// Weight and inertia of a body as a load on what holds it, in the root's frame.
Wrench bodyLoad(const RigidBody& body, const Pose& X_BL, const LinkState& link) noexcept {
  const Eigen::Matrix3d& R = X_BL.linear();
  const Eigen::Vector3d r = R * body.com;
  const Eigen::Vector3d rate_L = R.transpose() * link.rate;
  const Eigen::Vector3d moment_L =
      body.inertia * (R.transpose() * link.angular_acceleration) + rate_L.cross(body.inertia * rate_L);
  Wrench load;
  load.force = -body.mass * link.accelerationAt(r);
  load.torque = (X_BL.translation() + r).cross(load.force) - R * moment_L;
  return load;
}

Wrench sum(const Wrench& a, const Wrench& b) noexcept { return {a.force + b.force, a.torque + b.torque}; }

Wrench forceAt(const Eigen::Vector3d& p, const Eigen::Vector3d& force) noexcept { return {force, p.cross(force)}; }

/// From the root's frame to a point with the axes R of the root's frame.
Wrench seenAt(const Eigen::Vector3d& p, const Eigen::Matrix3d& R, const Wrench& w_B) noexcept {
  return {R.transpose() * w_B.force, R.transpose() * (w_B.torque - p.cross(w_B.force))};
}

RigidBody bodyOf(const KDL::Segment& segment) {
  KDL::RigidBodyInertia given = segment.getInertia();  // its RefPoint() is not const
  RigidBody body;
  body.mass = given.getMass();
  const KDL::Vector com = given.getCOG();
  body.com = {com.x(), com.y(), com.z()};
  const KDL::RotationalInertia about_com = given.RefPoint(com).getRotationalInertia();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) body.inertia(r, c) = about_com.data[3 * r + c];
  }
  return body;
}

}  // namespace

struct SteelLoadFinder::Working {
  std::array<LinkState, kMaxLinks> link;
  std::array<Wrench, kMaxLinks> beyond;     ///< hammer, weight, inertia of this link and all beyond
  std::array<Wrench, kMaxJoints> cylinder;  ///< ON the link beyond, by each cylinder
};

SteelLoadFinder::SteelLoadFinder(const Chain& chain, const std::vector<Cylinder>& cylinders,
                                 std::vector<Section> sections)
    : chain_(chain), sections_(std::move(sections)) {
  body_.emplace_back();  // the root's own load goes into the ground
  for (const KDL::Segment& segment : chain_.kdl().segments) body_.push_back(bodyOf(segment));
  for (const Cylinder& cylinder : cylinders) {
    const CylinderParameters& p = cylinder.parameters();
    anchors_.push_back(
        {cylinder, chain_.linkBeyond(cylinder.joint()), {p.base_x, 0.0, p.base_z}, {p.rod_x, 0.0, p.rod_z}});
  }
  for (const Section& section : sections_) {
    std::vector<std::size_t>& crossing = crossing_.emplace_back();
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      const Anchors& a = anchors_[i];
      if ((a.beyond == section.link() && section.beyond(a.rod_L)) ||
          (a.beyond == section.link() + 1 && !section.beyond(a.base_P)))
        crossing.push_back(i);
    }
  }
}

bool SteelLoadFinder::find(const ChainState& state, SteelLoads& result) const noexcept {
  Working working;
  const bool finite = addInertiaAndWeight(state, working);
  findCylinders(state, working, result);
  findJoints(state, working, result);
  findSections(state, working, result);
  return finite;
}

bool SteelLoadFinder::addInertiaAndWeight(const ChainState& state, Working& working) const noexcept {
  working.link[0].acceleration = -state.g_B;
  const int links = chain_.links();
  for (int i = 1; i < links; ++i) {
    const auto here = static_cast<std::size_t>(i);
    const LinkState& before = working.link[here - 1];
    LinkState& now = working.link[here];
    now = before;
    now.acceleration =
        before.accelerationAt(state.pose.X_BL[here].translation() - state.pose.X_BL[here - 1].translation());
    const int joint = chain_.link(i).joint;
    if (joint < 0) continue;
    const Eigen::Vector3d& axis = state.pose.axis_B[static_cast<std::size_t>(joint)];
    const Eigen::Vector3d velocity = axis * state.motion.velocity[joint];
    const Eigen::Vector3d acceleration = axis * state.motion.acceleration[joint];
    if (state.pose.prismatic[static_cast<std::size_t>(joint)]) {
      now.acceleration += acceleration + 2.0 * before.rate.cross(velocity);
    } else {
      now.rate += velocity;
      now.angular_acceleration += acceleration + before.rate.cross(velocity);
    }
  }
  const Pose& X_BT = state.pose.tip();
  Wrench load{X_BT.linear() * state.w_tip.force, X_BT.linear() * state.w_tip.torque};
  load.torque += X_BT.translation().cross(load.force);
  bool finite = true;
  for (int i = links - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    load = sum(load, bodyLoad(body_[here], state.pose.X_BL[here], working.link[here]));
    working.beyond[here] = load;
    finite = finite && load.force.cwiseAbs().sum() < kMostLoad && load.torque.cwiseAbs().sum() < kMostLoad;
  }
  return finite;
}

void SteelLoadFinder::findCylinders(const ChainState& state, Working& working, SteelLoads& result) const noexcept {
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const Anchors& a = anchors_[i];
    const auto joint = static_cast<std::size_t>(a.cylinder.joint()), beyond = static_cast<std::size_t>(a.beyond);
    const Wrench& load = working.beyond[beyond];
    const double torque = state.pose.axis_B[joint].dot(load.torque - state.pose.p_BJ_B[joint].cross(load.force));
    const CylinderPosition& at = state.cylinders[i];
    const Pose &X_BP = state.pose.X_BL[beyond - 1], &X_BL = state.pose.X_BL[beyond];
    const Eigen::Vector3d rod_B = X_BL * a.rod_L;
    const Eigen::Vector3d push = a.cylinder.load(at, torque).force * (rod_B - X_BP * a.base_P).normalized();
    working.cylinder[i] = forceAt(rod_B, push);
    result.pins[i] = {-(X_BP.linear().transpose() * push), X_BL.linear().transpose() * push};
  }
}

void SteelLoadFinder::findJoints(const ChainState& state, const Working& working, SteelLoads& result) const noexcept {
  for (int j = 0; j < chain_.joints(); ++j) {
    const int beyond = chain_.linkBeyond(j);
    Wrench load = working.beyond[static_cast<std::size_t>(beyond)];
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      if (anchors_[i].cylinder.joint() == j) load = sum(load, working.cylinder[i]);
    }
    const Pose& X_BP = state.pose.link(beyond - 1);
    result.joint[static_cast<std::size_t>(j)] = seenAt(X_BP * chain_.link(beyond).origin, X_BP.linear(), load);
  }
}

void SteelLoadFinder::findSections(const ChainState& state, const Working& working, SteelLoads& result) const noexcept {
  for (std::size_t k = 0; k < sections_.size(); ++k) {
    const Section& section = sections_[k];
    const auto link = static_cast<std::size_t>(section.link());
    const Pose& X_BL = state.pose.X_BL[link];
    Wrench load = sum(working.beyond[link + 1], bodyLoad(section.part(), X_BL, working.link[link]));
    for (std::size_t i : crossing_[k]) load = sum(load, working.cylinder[i]);
    const Pose& X_LC = section.poseInLink();
    result.section[k] = seenAt(X_BL * X_LC.translation(), X_BL.linear() * X_LC.linear(), load);
  }
}

}  // namespace hammer_loads
