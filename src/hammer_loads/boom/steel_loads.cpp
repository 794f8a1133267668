#include "hammer_loads/boom/steel_loads.h"

#include <utility>

#include "hammer_loads/boom/body_motion.h"
#include "hammer_loads/util/inline.h"

namespace hammer_loads {
namespace {

/// No product of it with lengths and levers of a chain that could be built overflows [N], [N m].
constexpr double kMostLoad = 1e200;

Wrench forceAt(const Eigen::Vector3d& p, const Eigen::Vector3d& force) noexcept { return {force, p.cross(force)}; }

/// From the root's frame to a point with the axes R of the root's frame.
HAMMER_LOADS_INLINE Wrench seenAt(const Eigen::Vector3d& p, const Eigen::Matrix3d& R, const Wrench& w_B) noexcept {
  return {R.transpose() * w_B.force, R.transpose() * (w_B.torque - p.cross(w_B.force))};
}

}  // namespace

struct SteelLoadFinder::Working {
  std::array<Wrench, kMaxLinks> beyond;     ///< hammer, weight, inertia of this link and all beyond
  std::array<Wrench, kMaxJoints> cylinder;  ///< ON the link beyond, by each cylinder
};

SteelLoadFinder::SteelLoadFinder(const Chain& chain, const std::vector<Cylinder>& cylinders,
                                 std::vector<Section> sections)
    : chain_(chain), sections_(std::move(sections)) {
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
  const bool finite = addHammer(state, working);
  findCylinders(state, working, result);
  findJoints(state, working, result);
  findSections(state, working, result);
  return finite;
}

bool SteelLoadFinder::addHammer(const ChainState& state, Working& working) const noexcept {
  const Pose& X_BT = state.pose.tip();
  Wrench hammer{X_BT.linear() * state.w_tip.force, X_BT.linear() * state.w_tip.torque};
  hammer.torque += X_BT.translation().cross(hammer.force);
  bool finite = true;
  for (int i = chain_.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    const Wrench& load = working.beyond[here] = hammer + state.links.beyond[here];
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
      if (anchors_[i].cylinder.joint() == j) load = load + working.cylinder[i];
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
    Wrench load = working.beyond[link + 1] + bodyLoad(section.part(), X_BL, state.links.motion[link]);
    for (std::size_t i : crossing_[k]) load = load + working.cylinder[i];
    const Pose& X_LC = section.poseInLink();
    result.section[k] = seenAt(X_BL * X_LC.translation(), X_BL.linear() * X_LC.linear(), load);
  }
}

}  // namespace hammer_loads
