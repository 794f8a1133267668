/// Boom joint motion at the instants of the crank samples, interpolated between joint states.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/boom/chain.h"
#include "hammer_loads/settings/pipeline_settings.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// Reason why the joints' motion is not known at an instant.
struct JointFault {
  /// kRunAway: the boom's vibration was implausibly large and is reset
  enum class Kind { kMissing, kStale, kRunAway };
  Kind kind{};
  int joint{};   ///< the first one concerned, index in the chain; of kRunAway 0
  double age{};  ///< from its nearest state to the instant [s]; infinity for a missing one
};

/// Refused joint states, by reason.
struct JointRefusals {
  std::uint64_t not_finite{};    ///< position or velocity; a position with a bad velocity counts as one without
  std::uint64_t short_array{};   ///< fewer positions, or fewer velocities than positions, than names
  std::uint64_t jumps{};         ///< no joint moves so fast; a second one in a row is accepted
  std::uint64_t out_of_order{};  ///< not newer than the state before it; a joint named twice in a message
};

/// The last states of each joint of a chain. Messages may hold any subset of the joints in any order, with or without
/// velocities; other joints are ignored. Between two states of a joint position and velocity are linear in time; beyond
/// the newest they are held.
///
/// A velocity that is not measured is the difference of the positions before and after it, zero until there are two.
/// Neglects: acceleration of a joint between its states (error of the position a'' h^2/8: 3e-5 rad for 0.5 rad/s2 at 50
/// Hz).
class JointBuffer {
 public:
  /// zeros: readings of the joints at the chain's zeros, which are subtracted. None: zero.
  JointBuffer(const Chain& chain, const PipelineSettings& settings, const JointVector& zeros = {});

  /// Takes the states of the chain's joints. Returns true if there were any. A jump back in time is accepted with a
  /// joint's second state, since the first one may be late. No allocation.
  bool update(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
              const std::vector<double>& velocities) noexcept;
  /// Finds the motion at an instant or returns the reason why it is unknown (`motion` is then invalid). No allocation.
  std::optional<JointFault> at(StampNs stamp, JointMotion& motion) const noexcept;

  /// A joint's angle as received.
  struct Reading {
    StampNs stamp{};
    double position{};
  };
  /// Returns the newest reading of a joint; empty if there is none.
  std::optional<Reading> newest(int joint) const noexcept;

  const JointRefusals& refusals() const noexcept { return refusals_; }
  const std::string& name(int joint) const noexcept { return names_[static_cast<std::size_t>(joint)]; }
  /// Returns texts on joints that are missing or stale at an instant, for diagnostics: "arm_joint: never heard".
  std::vector<std::string> complaints(StampNs stamp) const;

 private:
  struct State {
    StampNs stamp{};
    double position{}, velocity{};
    double acceleration{};  ///< mean since the state before it
    double velocity_age{};  ///< time from the instant of the velocity to the stamp [s]
  };
  /// Some 0.6 s at 100 Hz: how far a crank sample may lie behind the joint states.
  static constexpr std::uint64_t kKept = 64;
  // Numerical: kKept
  struct Track {
    std::array<State, kKept> states;
    std::uint64_t count{};           ///< number of states since the beginning; the newest is count - 1
    std::optional<StampNs> rewound;  ///< stamp of the last state, if it was refused as out of order
    bool jumped{};                   ///< the last state was refused as a jump
    bool turns_freely{};             ///< no limits: positions may wind, the shorter way counts

    const State& back(std::uint64_t steps) const noexcept { return states[(count - 1 - steps) % kKept]; }
    double difference(double from, double to) const noexcept;
  };
  /// The states around an instant.
  struct Bracket {
    const State* before{};  ///< the oldest one if none is before
    const State* after{};   ///< null: held
    double age{};           ///< from the nearest of them [s]
  };

  bool isInOrder(Track& track, StampNs stamp) noexcept;
  bool jumps(Track& track, StampNs stamp, double position) noexcept;
  void add(Track& track, StampNs stamp, double position, std::optional<double> velocity) noexcept;
  static void replace(Track& track, State next, bool has_velocity) noexcept;
  static Bracket around(const Track& track, StampNs stamp) noexcept;
  std::optional<JointFault> fault(int joint, const Bracket& bracket) const noexcept;

  std::vector<std::string> names_;
  std::vector<double> zeros_;
  std::vector<Track> tracks_;
  double max_age_;
  bool differentiate_;
  JointRefusals refusals_;
};

}  // namespace hammer_loads
