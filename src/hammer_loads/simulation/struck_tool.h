/// Target of an elastic machine's rocker: a tool on yielding rock, the hull's retainer, or none.
#pragma once

#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/normal_noise.h"

namespace hammer_loads::simulation {

/// Tool along its axis, down positive, from where it stood when the turn began, and the rock below it.
struct ToolState {
  double way{};      ///< [m]
  double speed{};    ///< [m/s]
  double yielded{};  ///< permanent deformation of the rock [m]
};

/// Contact forces grow from zero with the depth of pressing, and with its speed (Hunt and Crossley 1975): a spring and
/// a loss that never pulls. The rock yields above its strength, within some 10 us.
/// Neglects: waves within tool and rocker, friction of the tool's bush, motion of the hull during the blow. The tool is
/// reset to its place in each turn.
class StruckTool {
 public:
  /// Depth of the striking point below its place at the dead centre [m], and its speed [m/s].
  struct Striker {
    double depth{}, speed{};
  };
  struct Answer {
    double tool{}, retainer{};                            ///< up, on the rocker [N]
    ToolState rate;                                       ///< derivative of the tool's state
    double contact_loss{}, rock_loss{}, retainer_loss{};  ///< [W]
  };

  StruckTool(const MachineSettings& settings);

  Answer answer(Striker striker, const ToolState& tool, double gravity_down) const noexcept;
  double energy(Striker striker, const ToolState& tool) const noexcept;  ///< kinetic and elastic [J]
  /// Code of the contacts, for a step that must not run over a change: equal means the same contacts.
  int contacts(Striker striker, const ToolState& tool) const noexcept;
  static bool touches(int contacts) noexcept { return (contacts & 3) != 0; }
  /// Resets the tool for the turn that begins at a time [s]. It consumes the same random numbers for any settings.
  void newTurn(double time) noexcept;
  bool isThere() const noexcept { return there_; }

 private:
  double onTool(Striker striker, const ToolState& tool) const noexcept;
  double onRock(const ToolState& tool) const noexcept;

  StrikeSettings s_;
  double blank_share_;
  NormalNoise draws_;
  double place_{};  ///< place of the tool's top [m]
  bool there_{true};
};

}  // namespace hammer_loads::simulation
