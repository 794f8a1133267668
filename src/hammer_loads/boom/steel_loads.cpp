#include "hammer_loads/boom/steel_loads.h"

#include <cmath>
#include <utility>

#include "hammer_loads/boom/body_motion.h"
#include "hammer_loads/boom/lanes.h"
#include "hammer_loads/util/avx2.h"

namespace hammer_loads {
namespace {

/// No product of it with lengths and levers of a chain that could be built overflows [N], [N m].
constexpr double kMostLoad = 1e200;

/// Axes of a link.
HAMMER_LOADS_INLINE TransposedLanes axesOf(const Pose& X_BL) noexcept {
  return transposed(lanesAt(X_BL.data()), lanesAt(X_BL.data() + 4), lanesAt(X_BL.data() + 8));
}

/// At a point, in axes of its own.
HAMMER_LOADS_INLINE void seeAt(const Lanes& p, const TransposedLanes& axes, const LaneWrench& w,
                               Wrench& seen) noexcept {
  store(axes * w.force, seen.force);
  store(axes * (w.torque - cross(p, w.force)), seen.torque);
}

}  // namespace

struct SteelLoadFinder::Working {
  std::array<LaneWrench, kMaxLinks> beyond;     ///< hammer, weight, inertia of this link and all beyond
  std::array<LaneWrench, kMaxJoints> cylinder;  ///< ON the link beyond, by each cylinder
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
  return kHasAvx2 ? findByAvx2(state, result) : findByAny(state, result);
}

HAMMER_LOADS_AVX2 bool SteelLoadFinder::findByAvx2(const ChainState& state, SteelLoads& result) const noexcept {
  return findByAny(state, result);
}

HAMMER_LOADS_INLINE bool SteelLoadFinder::findByAny(const ChainState& state, SteelLoads& result) const noexcept {
  Working working;
  const bool finite = addHammer(state, working);
  findCylinders(state, working, result);
  findJoints(state, working, result);
  findSections(state, working, result);
  return finite;
}

HAMMER_LOADS_INLINE bool SteelLoadFinder::addHammer(const ChainState& state, Working& working) const noexcept {
  const Pose& X_BT = state.pose.tip();
  LaneWrench hammer{product(X_BT.data(), state.w_tip.force.data()), product(X_BT.data(), state.w_tip.torque.data())};
  hammer.torque += cross(originOf(X_BT), hammer.force);
  bool finite = true;
  for (int i = chain_.links() - 1; i > 0; --i) {
    const auto here = static_cast<std::size_t>(i);
    LaneWrench& load = working.beyond[here] = hammer;
    add(lanesOf(state.links.beyond[here]), load);
    for (int k = 0; k < 3; ++k)
      finite = finite && std::abs(load.force[k]) < kMostLoad && std::abs(load.torque[k]) < kMostLoad;
  }
  return finite;
}

HAMMER_LOADS_INLINE void SteelLoadFinder::findCylinders(const ChainState& state, Working& working,
                                                        SteelLoads& result) const noexcept {
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const Anchors& a = anchors_[i];
    const auto joint = static_cast<std::size_t>(a.cylinder.joint()), beyond = static_cast<std::size_t>(a.beyond);
    const LaneWrench& load = working.beyond[beyond];
    const double torque =
        dot(lanesOf(state.pose.axis_B[joint]), load.torque - cross(lanesOf(state.pose.p_BJ_B[joint]), load.force));
    const Pose &X_BP = state.pose.X_BL[beyond - 1], &X_BL = state.pose.X_BL[beyond];
    const Lanes rod = pointAt(X_BL, a.rod_L.data()), along = rod - pointAt(X_BP, a.base_P.data());
    const Lanes push = a.cylinder.load(state.cylinders[i], torque).force / std::sqrt(dot(along, along)) * along;
    working.cylinder[i] = {push, cross(rod, push)};
    store(axesOf(X_BP) * -push, result.pins[i].base);
    store(axesOf(X_BL) * push, result.pins[i].rod);
  }
}

HAMMER_LOADS_INLINE void SteelLoadFinder::findJoints(const ChainState& state, const Working& working,
                                                     SteelLoads& result) const noexcept {
  for (int j = 0; j < chain_.joints(); ++j) {
    const int beyond = chain_.linkBeyond(j);
    LaneWrench load = working.beyond[static_cast<std::size_t>(beyond)];
    for (std::size_t i = 0; i < anchors_.size(); ++i) {
      if (anchors_[i].cylinder.joint() == j) add(working.cylinder[i], load);
    }
    const Pose& X_BP = state.pose.link(beyond - 1);
    seeAt(pointAt(X_BP, chain_.link(beyond).origin.data()), axesOf(X_BP), load,
          result.joint[static_cast<std::size_t>(j)]);
  }
}

HAMMER_LOADS_INLINE void SteelLoadFinder::findSections(const ChainState& state, const Working& working,
                                                       SteelLoads& result) const noexcept {
  for (std::size_t k = 0; k < sections_.size(); ++k) {
    const Section& section = sections_[k];
    const auto link = static_cast<std::size_t>(section.link());
    const Pose &X_BL = state.pose.X_BL[link], &X_LC = section.poseInLink();
    LaneWrench load = working.beyond[link + 1];
    add(lanesOf(bodyLoad(section.part(), X_BL, state.links.motion[link])), load);
    for (std::size_t i : crossing_[k]) add(working.cylinder[i], load);
    const double *R = X_BL.data(), *own = X_LC.data();
    const TransposedLanes axes = transposed(product(R, own), product(R, own + 4), product(R, own + 8));
    seeAt(pointAt(X_BL, X_LC.data() + 12), axes, load, result.section[k]);
  }
}

}  // namespace hammer_loads
