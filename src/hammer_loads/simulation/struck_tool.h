/// Target of an elastic machine's rocker: a tool on yielding rock, the hull's retainer, or none.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

/// State of tool and rock along the tool's axis, positive downwards, from the beginning of the revolution.
struct ToolState {
  double way{};      ///< [m]
  double speed{};    ///< [m/s]
  double yielded{};  ///< permanent deformation of the rock [m]
};

/// Contact forces grow from zero with the indentation and its rate (Hunt and Crossley 1975): a spring and a loss that
/// never pulls. The rock yields above its strength, within some 10 us.
/// Neglects: waves within tool and rocker, friction of the tool's bush, motion of the hull during the blow. The tool is
/// reset to its initial position in each revolution.
class StruckTool {
 public:
  /// Depth of the striking point below its position at the dead centre [m], and its rate [m/s].
  struct Striker {
    double depth{}, speed{};
  };
  struct Answer {
    double tool{}, retainer{};                            ///< forces on the rocker, positive upwards [N]
    ToolState rate;                                       ///< derivative of the tool's state
    double contact_loss{}, rock_loss{}, retainer_loss{};  ///< [W]
  };

  StruckTool(const MachineSettings& settings);

  Answer answer(Striker striker, const ToolState& tool, double gravity_down) const noexcept;
  double energy(Striker striker, const ToolState& tool) const noexcept;  ///< kinetic and elastic [J]
  /// Returns a code of the present contacts; a step must not pass a change of it.
  int contacts(Striker striker, const ToolState& tool) const noexcept;
  static bool touches(int contacts) noexcept { return (contacts & 3) != 0; }
  /// Resets the tool for the revolution that begins at a time [s]. Consumes the same random numbers for any settings.
  void newTurn(double time) noexcept;
  bool isThere() const noexcept { return there_; }

 private:
  double onTool(Striker striker, const ToolState& tool) const noexcept;
  double onRock(const ToolState& tool) const noexcept;

  StrikeSettings s_;
  double blank_share_;
  NormalNoise draws_;
  double place_{};  ///< depth of the tool's top [m]
  bool there_{true};
};

/// Groups the contacts of tool and retainer into blows. A blow begins with a contact at more than 1 m/s and includes
/// all contacts of the next 20 ms. A rocker that falls onto the tool with the supply shut is slower and is not counted.
class BlowFollower {
 public:
  struct Instant {
    double time{};
    double crank_speed{}, rocker_speed{};                      ///< [rad/s]
    double approach{};                                         ///< speed of the striking point, down [m/s]
    double tool_impulse{}, tool_energy{}, retainer_impulse{};  ///< since the start [N s], [J], [N s]
    bool touches{};
  };
  /// Evaluates a step. Returns the blow that begins now, or null; the caller sets its revolution.
  BlowTruth* follow(const Instant& now);
  /// Removes and returns the blows that ended since the last call.
  std::vector<BlowTruth> take() { return std::exchange(blows_, {}); }

 private:
  struct Meeting {
    BlowTruth truth;
    Instant begun;
    double touched{};  ///< beginning of the last contact [s]
  };
  void end(const Instant& now);
  std::optional<Meeting> meeting_;
  bool touched_{};
  std::vector<BlowTruth> blows_;
};

}  // namespace hammer_loads::simulation
