#include "hammer_loads/boom/steel_loads.h"

#include <cmath>
#include <utility>

#include "hammer_loads/boom/chain_dynamics.h"
#include "hammer_loads/util/inline.h"

namespace hammer_loads {
namespace {

/// Bound of a load; its products with the lengths and levers of any machine do not overflow [N], [N m].
constexpr double kMostLoad = 1e200;
// Numerical: kMostLoad

/// Wrench in the root's frame, transformed to a point and to axes of its own.
HAMMER_LOADS_INLINE Wrench seenAt(const Eigen::Vector3d& p, const Eigen::Matrix3d& axes, const Wrench& w) noexcept {
  return {axes.transpose() * w.force, axes.transpose() * (w.torque - p.cross(w.force))};
}

}  // namespace

struct SteelLoadFinder::Working {
  std::array<Wrench, kMaxLinks> beyond;                      ///< hammer, weight, inertia of this link and all beyond
  std::array<std::array<Wrench, kPins>, kMaxJoints> by_pin;  ///< ON the chain's links, by each cylinder
};

SteelLoadFinder::SteelLoadFinder(const Chain& chain, const std::vector<Cylinder>& cylinders,
                                 std::vector<Section> sections)
    : chain_(chain), sections_(std::move(sections)) {
  for (const Cylinder& cylinder : cylinders) {
    const CylinderParameters& p = cylinder.parameters();
    const Eigen::Vector3d base(p.base_x, 0.0, p.base_z), rod(p.rod_x, 0.0, p.rod_z);
    const Eigen::Vector3d guide = p.linkage ? Eigen::Vector3d(p.linkage->guide_x, 0.0, p.linkage->guide_z) : base;
    anchors_.push_back({cylinder, chain_.linkBeyond(cylinder.joint()), base, guide, rod});
  }
  for (const Section& section : sections_) crossing_.push_back(crossing(section));
}

/// The forces of a cylinder's pins are in balance: only those of one that has pins on both sides count.
std::vector<SteelLoadFinder::Crossing> SteelLoadFinder::crossing(const Section& section) const {
  std::vector<Crossing> all;
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const Anchors& a = anchors_[i];
    const auto isBeyond = [&](int link, const Eigen::Vector3d& pin) {
      return link > section.link() || (link == section.link() && section.beyond(pin));
    };
    const bool base = isBeyond(a.beyond - 1, a.base_P), guide = isBeyond(a.beyond - 1, a.guide_P),
               rod = isBeyond(a.beyond, a.rod_L);
    if (base == guide && guide == rod) continue;
    if (base) all.push_back({i, kBase});
    if (guide && a.cylinder.linkage()) all.push_back({i, kGuide});
    if (rod) all.push_back({i, kRod});
  }
  return all;
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
    const Eigen::Vector3d rod = X_BL * a.rod_L;
    const double force = a.cylinder.load(state.cylinders[i], torque).force;
    std::array<Eigen::Vector3d, kPins> by{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    if (a.cylinder.linkage()) {
      const BucketLinkageForces links =
          a.cylinder.linkage()->forces(state.cylinders[i].rod_pin, state.cylinders[i].driven_pin);
      const auto of = [&](const Eigen::Vector2d& share) -> Eigen::Vector3d {
        return X_BP.linear() * Eigen::Vector3d(-force * share.x(), 0.0, -force * share.y());
      };
      by = {of(links.rod), of(links.guide), of(links.coupler)};
    } else {
      const Eigen::Vector3d along = rod - X_BP * a.base_P;
      by[kRod] = force / along.norm() * along, by[kBase] = -by[kRod];
    }
    const auto at = [](const Eigen::Vector3d& pin, const Eigen::Vector3d& push) {
      return Wrench{push, pin.cross(push)};
    };
    working.by_pin[i] = {at(X_BP * a.base_P, by[kBase]), at(X_BP * a.guide_P, by[kGuide]), at(rod, by[kRod])};
    const auto before = X_BP.linear().transpose();
    result.pins[i] = {before * by[kBase], before * by[kGuide], X_BL.linear().transpose() * by[kRod]};
  }
}

void SteelLoadFinder::findJoints(const ChainState& state, const Working& working, SteelLoads& result) const noexcept {
  for (int j = 0; j < chain_.joints(); ++j) {
    const int beyond = chain_.linkBeyond(j);
    Wrench load = working.beyond[static_cast<std::size_t>(beyond)];
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      if (anchors_[i].cylinder.joint() == j) load = load + working.by_pin[i][kRod];
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
    for (const Crossing& c : crossing_[k]) load = load + working.by_pin[c.cylinder][c.pin];
    const Pose X_BC = X_BL * section.poseInLink();
    result.section[k] = seenAt(X_BC.translation(), X_BC.linear(), load);
  }
}

}  // namespace hammer_loads
