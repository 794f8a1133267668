/// The hull's motion from its IMU and the load that drives it, with jumps at blows.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "hammer_loads/boom/boom.h"
#include "hammer_loads/boom/chain_dynamics.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/driven_signal.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/wrench_path.h"

namespace hammer_loads {

/// Mobility of links and hull from a robot description. The joints of cylinders turn; all other joints are held.
class HullMobility {
 public:
  /// position: of the unit, from D in axes of the hull [m].
  HullMobility(const Boom& boom, const Eigen::Vector3d& position);

  /// Rows: acceleration of the unit along x and z [m/s2], about y [rad/s2]. Columns: force along x and z [N], moment
  /// about D [N m].
  struct Mobility {
    Eigen::Matrix3d value;  ///< J M^-1 J^T
    Eigen::Matrix3d most;   ///< largest possible value of each entry if the links were coupled otherwise
  };
  /// Returns the mobility at a pose. Empty if links have no inertia, if no joint has a cylinder, or if no joint has
  /// moved by the boom's refresh_angle since the last one.
  std::optional<Mobility> movedTo(const JointVector& position) noexcept;

 private:
  Chain chain_;
  MassMatrix mass_;
  ChainPose pose_;
  std::vector<int> joints_;
  Eigen::Vector3d unit_;
  double refresh_angle_;  ///< [rad]
  JointVector at_;        ///< positions of the last call; empty: none
};

/// Covariance of effective gravity along x and z [m/s2], angular velocity [rad/s] and its derivative [rad/s2], in this
/// order. The errors of the hull's motion are independent of the crank's.
using HullMotionCovariance = Eigen::Matrix4d;

struct KnownHullMotion {
  HullMotion motion;
  HullMotionCovariance covariance = HullMotionCovariance::Zero();
};

/// Filters three signals at the unit, each driven by the load of links and drive: force along x, force along z, and the
/// rate about y. Readings wait for the next crank sample, which determines the load at their stamps. No later data are
/// used. The effective inertia of the hull at D, on its boom and oil or on rock, is estimated. A boom file is not
/// required, but gives the initial value.
class HullMotionFilter {
 public:
  HullMotionFilter(const HullImuSettings& imu, const HammerParameters& hammer);

  /// Sets the mobility of the hull from a robot description.
  void expect(const HullMobility::Mobility& mobility) noexcept;
  /// Adds an accepted reading in axes of hammer_hull.
  void add(const StampedImuReading& reading) noexcept { waiting_.add(reading); }
  /// Takes a crank sample and the load of the step that it ends. beside: other loads on the hull at the sample. A step
  /// without pieces resets the motion.
  void follow(StampNs sample, const WrenchHistory& step, const HullWrench& other_load) noexcept;
  /// Returns the motion at a stamp, from the second reading with a known load until the last one is max_age old. The
  /// slow part is predicted until the next reading is overdue and then held, since a longer prediction diverges.
  std::optional<KnownHullMotion> at(StampNs stamp) const noexcept;
  /// Returns the number of readings up to a stamp that no crank sample has followed yet.
  std::ptrdiff_t waiting(StampNs stamp) const noexcept { return waiting_.upTo(stamp); }
  /// Returns the covariance of an unmeasured hull's motion about its weight: twice the immediate response to the load
  /// of the last 2 s, as far as its mass is known. The angular velocity is negligible.
  HullMotionCovariance unread() const noexcept;
  /// Returns the stamp of the last reading used [ns].
  StampNs last() const noexcept { return last_.stamp; }

 private:
  template <typename Signals, typename Each>
  void forEachStep(StampNs to, const Signals& signals, const Each& each) const noexcept;
  void update(const StampedImuReading& reading) noexcept;
  void forgetMotion() noexcept;
  void beginAnew() noexcept;
  bool works(const Eigen::Vector3d& load) noexcept;

  HullImuSettings settings_;
  DrivenSignal x_, z_, turning_;
  std::optional<HullMobility::Mobility> mobility_;  ///< from the last description
  WrenchPath path_;
  WaitingReadings waiting_;
  StampedImuReading last_;
  WrenchPath::Instant at_last_;
  HullWrench other_load_;
  RunningMean<Eigen::Vector3d> load_square_{look_back::kTenTurns, Eigen::Vector3d::Zero()};  ///< mean square
  int readings_{};
  double interval_{};  ///< time between the last two readings [s]
  double greatest_load_{};
};

}  // namespace hammer_loads
