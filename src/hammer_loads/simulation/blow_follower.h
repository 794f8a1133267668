/// Groups the contacts of tool and retainer into blows.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

/// A blow begins with a contact at more than 1 m/s and includes all contacts of the next 20 ms. A rocker that falls
/// onto the tool with the supply shut is slower and makes no blow.
class BlowFollower {
 public:
  struct Instant {
    double time{};
    double crank_speed{}, rocker_speed{};                      ///< [rad/s]
    double approach{};                                         ///< speed of the striking point, down [m/s]
    double tool_impulse{}, tool_energy{}, retainer_impulse{};  ///< since the start [N s], [J], [N s]
    bool touches{};
  };
  /// After each step. Revolution before the blow that begins now, for the caller to fill in.
  BlowTruth* follow(const Instant& now);
  /// Removes and returns the blows that ended since the last call.
  std::vector<BlowTruth> take() { return std::exchange(blows_, {}); }

 private:
  struct Meeting {
    BlowTruth truth;
    Instant begun;
    double touched{};  ///< last time [s]
  };
  void end(const Instant& now);
  std::optional<Meeting> meeting_;
  bool touched_{};
  std::vector<BlowTruth> blows_;
};

}  // namespace hammer_loads::simulation
