#include "hammer_loads/boom/steel_loads.h"

#include <cmath>
#include <utility>

#include "hammer_loads/boom/body_motion.h"
#include "hammer_loads/util/inline.h"

namespace hammer_loads {
namespace {

/// No product of it with lengths and levers of a chain that could be built overflows [N], [N m].
constexpr double kMostLoad = 1e200;
// Numerical: kMostLoad

/// Of the root's frame, at a point, in axes of its own.
HAMMER_LOADS_INLINE Wrench seenAt(const Eigen::Vector3d& p, const Eigen::Matrix3d& axes, const Wrench& w) noexcept {
  return {axes.transpose() * w.force, axes.transpose() * (w.torque - p.cross(w.force))};
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
  const Wrench hammer = shifted(state.pose.tip(), state.w_tip);
  bool finite = true;
  for (int i = chain_.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    const Wrench& load = working.beyond[here] = hammer + state.links.beyond[here];
    finite = finite && (load.force.array().abs() < kMostLoad).all() && (load.torque.array().abs() < kMostLoad).all();
  }
  return finite;
}

void SteelLoadFinder::findCylinders(const ChainState& state, Working& working, SteelLoads& result) const noexcept {
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const Anchors& a = anchors_[i];
    const auto joint = static_cast<std::size_t>(a.cylinder.joint()), beyond = static_cast<std::size_t>(a.beyond);
    const Wrench& load = working.beyond[beyond];
    const double torque = state.pose.axis_B[joint].dot(load.torque - state.pose.p_BJ_B[joint].cross(load.force));
    const Pose &X_BP = state.pose.X_BL[beyond - 1], &X_BL = state.pose.X_BL[beyond];
    const Eigen::Vector3d rod = X_BL * a.rod_L, along = rod - X_BP * a.base_P;
    const Eigen::Vector3d push = a.cylinder.load(state.cylinders[i], torque).force / along.norm() * along;
    working.cylinder[i] = {push, rod.cross(push)};
    result.pins[i] = {X_BP.linear().transpose() * -push, X_BL.linear().transpose() * push};
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
    const Pose X_BC = X_BL * section.poseInLink();
    result.section[k] = seenAt(X_BC.translation(), X_BC.linear(), load);
  }
}

}  // namespace hammer_loads
