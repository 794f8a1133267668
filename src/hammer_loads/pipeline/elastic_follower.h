/// Level elastic around a blow: the crank and what the rocker beside its rigid place does to the hull.
#pragma once

#include <array>
#include <optional>

#include "hammer_loads/crank/rod_filter.h"
#include "hammer_loads/pipeline/crank_follower.h"

namespace hammer_loads {

/// Elsewhere, and where readings contradict the rod's model, the machine is that of level linkage.
class ElasticFollower {
 public:
  /// Below level elastic it never runs. Refers to the model, which must outlive it; may not be moved.
  ElasticFollower(const HullModel& model, Level level) noexcept;

  ElasticFollower(const ElasticFollower&) = delete;
  ElasticFollower& operator=(const ElasticFollower&) = delete;

  void rest() noexcept;
  /// Over the step to the crank's last sample, which continued.
  void follow(const CrankFollower& crank, Gravity gravity) noexcept;
  bool runs() const noexcept { return best_ != nullptr && best_->isRunning() && best_->isProven(); }

  /// While it runs: the crank as the two bodies have it.
  CrankEstimate crank() const noexcept;
  /// What the hull feels beside a rigid rod at that crank, and the standard deviation of the whole wrench by readings
  /// and rod. Of a ring that is known no better than it is large only a part is given (Wiener): its least square error.
  struct Beside {
    HullWrench wrench, deviation;
  };
  Beside beside(const DriveReaction& drive) const noexcept;
  /// Of the rocker's speed beside a rigid rod's and its standard deviation the root of the squares [rad/s].
  double speedBeside() const noexcept;
  /// While it runs: of a crank whose rigid rod moves the rocker as it is before the blow [rad/s].
  double strikingSpeed() const noexcept;
  /// Of the blow that was struck while it runs: the rocker's speed at the tool and its restitution, as a crank would
  /// feel them whose rod takes the rocker up at once.
  std::optional<CrankBlow> blow() const noexcept;
  /// Contact lasts, or may have begun or not.
  bool isBesideBlow() const noexcept;
  /// While it runs: with pins tight, or with play where the last blow showed one.
  const RodFilter& filter() const noexcept { return best_ != nullptr ? *best_ : filters_[0]; }

 private:
  Eigen::Vector3d beside(const RodMotion& motion) const noexcept;
  Eigen::Vector3d variance(const DriveReaction& drive) const noexcept;
  void begin(const CrankFollower& crank, const CrankFilter& filter, Gravity gravity) noexcept;
  const RodFilter& likelier() const noexcept;
  void judge() noexcept;
  bool mayBegin(const CrankFollower& crank, const CrankFilter& filter) const noexcept;

  const HullModel* model_;
  bool wanted_, runs_{};
  std::array<RodFilter, 2> filters_;
  double evidence_{};        ///< mean over some blows of the rod's fit less that of the rigid mechanism
  double rigid_fit_{};       ///< of this blow
  const RodFilter* best_{};  ///< null: rigid
  std::int64_t blow_{};      ///< CrankPosition::blow
};

}  // namespace hammer_loads
