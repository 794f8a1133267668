/// Hold-down capacity of the machine, limited by its weight and its cylinders.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "hammer_loads/boom/chain_pose.h"
#include "hammer_loads/boom/cylinder.h"

namespace hammer_loads {

/// Supports of the machine in the root's frame, all on the ground.
struct Supports {
  double front_x{};           ///< stabilisers, on the boom's side [m], > rear_x
  double front_half_width{};  ///< [m], > 0
  double rear_x{};            ///< far wheels or blade [m]
  double rear_half_width{};   ///< [m], > 0
};

/// Factors by which a mean load may act before a support or a cylinder yields. Infinity: the load relieves it, or the
/// machine's supports are not known; 0: it yields already.
struct HoldDown {
  double machine{};  ///< factor at which the machine tips over an edge of its supports or lifts
  int edge{};        ///< edge of machine: 0 front, 1 left, 2 rear, 3 right
  std::array<double, kMaxJoints>
      cylinder{};  ///< factor at which a relief valve opens, per cylinder; 0 at a zero moment arm
  double least{};  ///< smallest of all factors
  bool holds() const noexcept { return least >= 1.0; }
};

/// w_mean: mean load of the hammer on the tip, such as the mean hold-down force along +z at the striking line. Static;
/// no sliding; supports on level ground carry pressure only. g_B: gravity in the root's axes [m/s2].
HoldDown holdDown(const Chain& chain, const ChainPose& pose, const JointVector& position,
                  const std::vector<Cylinder>& cylinders, const std::optional<Supports>& supports, const Wrench& w_mean,
                  const Eigen::Vector3d& g_B) noexcept;

}  // namespace hammer_loads
