/// Follows a turn from blow to blow, so that its pulse is known when it ends.
#pragma once

#include <optional>
#include <vector>

#include "hammer_loads/hammer/hammer_model.h"

namespace hammer_loads {

/// State of the mechanism at an instant of a turn, as the recorder needs it.
struct TurnInstant {
  double time{};          ///< since any fixed origin [s]
  HullWrench wrench;      ///< weight included where the published wrench includes it
  LinkMomentum momentum;  ///< relative to the hull
  double weight_x{};      ///< weight within the wrench from here to the next instant [N]
  double weight_z{};      ///< as above [N]
};

/// Keeps the force and the exact impulses of the present turn in a track of bounded size: a turn with too many instants
/// loses every other point of it, never an impulse.
class TurnRecorder {
 public:
  TurnRecorder();

  /// A turn begins just after a blow.
  void begin(const TurnInstant& after_blow) noexcept;
  /// The momentum just after the blow is better known by now than when the turn began.
  void correctBegin(const LinkMomentum& after_blow) noexcept;
  /// Coming samples may not belong to the turn: its pulse is not given.
  void abandon() noexcept { recording_ = false; }
  bool recording() const noexcept { return recording_; }
  void add(const TurnInstant& instant) noexcept;
  /// Ends the turn just before a blow; no pulse if the turn was not seen whole or never pushed the hull up.
  std::optional<HalfSinePulse> end(const TurnInstant& before_blow) noexcept;

 private:
  void thin() noexcept;

  std::vector<TurnPoint> points_;
  TurnInstant first_, last_;
  double weight_impulse_x_{}, weight_impulse_z_{};
  std::size_t stride_{1}, skipped_{};
  bool recording_{};
};

}  // namespace hammer_loads
