/// Immediate response of a hull on its boom to a load, before the oil yields.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/boom/chain_dynamics.h"

namespace hammer_loads {

/// Mobility of links and hull of a robot description that turn in the joints of their cylinders; all other joints are
/// held.
class HullMobility {
 public:
  /// position: of the unit in axes of the hull, from D [m].
  HullMobility(const Boom& boom, const Eigen::Vector3d& position);

  /// Rows: acceleration of the unit along x and z [m/s2], turning about y [rad/s2]; columns: force along x and z [N],
  /// moment about D [N m].
  struct Mobility {
    Eigen::Matrix3d value;  ///< J M^-1 J^T
    Eigen::Matrix3d most;   ///< largest possible value of each entry if the links were coupled otherwise
  };
  /// At a pose. Nothing where no joint has moved by the boom's refresh_angle since
  /// the last one, where the links have no inertia or no joint has a cylinder.
  std::optional<Mobility> movedTo(const JointVector& position) noexcept;

 private:
  Chain chain_;
  ChainDynamics dynamics_;
  ChainPose pose_;
  std::vector<int> joints_;
  Eigen::Vector3d unit_;
  double refresh_angle_;  ///< [rad]
  JointVector at_;        ///< positions of the last call; empty: none
};

}  // namespace hammer_loads
