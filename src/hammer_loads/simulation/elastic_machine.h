/// Hydraulically driven hammer with an elastic rod and a blow of finite duration: the truth for the time after a blow.
#pragma once

#include <array>
#include <vector>

#include "hammer_loads/simulation/elastic_links.h"
#include "hammer_loads/simulation/struck_tool.h"
#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

/// Energy balance of an elastic machine since the start [J]. It is tested: kinetic + elastic + rod + blow = motor -
/// friction + weight.
struct ElasticEnergy {
  double motor{};     ///< work of the pressure on the shaft
  double friction{};  ///< dissipated on the shaft
  double weight{};    ///< work of the weight of links and tool
  double kinetic{};   ///< present energy of links and drive
  double elastic{};   ///< present energy of the rod
  double tool{};      ///< present kinetic energy of the tool and elastic energy of contacts and rock
  double rod{};       ///< dissipated in the rod's damper
  double blow{};      ///< dissipated in contacts, rock and retainer, and removed when the tool is reset
};

/// Crank with drive and rocker are two bodies, the rod is a spring between their pins, the tool is a third body. The
/// dead centre is no special case: without a blow the rocker passes it by its inertia. A blow follows from the contact
/// force, without an impact law. Neglects: motion of the hull except its pitch, a flexible coupling, bending of the
/// links. Integration by Dormand-Prince of order 5 with error control; no step exceeds a change of contact by more than
/// 10 ns. A machine with repeated contacts is chaotic. The steps are therefore independent of the requested times, so
/// that equal settings give equal motions. settings.rod.stiffness > 0. In BlowTruth, `time` is the first contact, and
/// the speeds after are those at the last separation. Energy and impulse are those through the tool, and a revolution
/// lasts from one first contact to the next.
class ElasticMachine {
 public:
  /// Throws std::invalid_argument when the hammer's linkage is impossible.
  explicit ElasticMachine(const MachineSettings& settings);

  /// time >= now [s].
  void advanceTo(double time);
  double time() const noexcept { return asked_; }
  /// Returns the present state. The load follows from the momentum theorem, with the tool's force and without the
  /// drive; the retainer is a part of the hull.
  CrankTruth truth() const noexcept;
  ElasticEnergy energy() const noexcept;
  /// Removes and returns the blows that ended since the last call.
  std::vector<BlowTruth> takeBlows() { return follower_.take(); }

 private:
  enum Index {
    kCrank,  // angle from the nearest dead centre
    kRocker,
    kCrankSpeed,
    kRockerSpeed,
    kToolWay,
    kToolSpeed,
    kYielded,
    kPressure,
    kControlled,  // the elements from here on are integrals
    kImpulseX = kControlled,
    kImpulseZ,
    kMotor,
    kFriction,
    kWeight,
    kRodLoss,
    kBlowLoss,
    kToolImpulse,
    kToolEnergy,
    kRetainerImpulse,
    kSize
  };
  using State = std::array<double, kSize>;
  struct Acting {
    double rod{}, rod_loss{};  ///< tension [N], dissipation [W]
    StruckTool::Answer struck;
    TwoBodies acceleration{};
    Load load;
    double weight{}, net_torque{};  ///< power of the weight [W], torque on the shaft [N m]
  };

  static TwoBodies angles(const State& y) noexcept { return {y[kCrank], y[kRocker]}; }
  static TwoBodies speeds(const State& y) noexcept { return {y[kCrankSpeed], y[kRockerSpeed]}; }
  static ToolState tool(const State& y) noexcept { return {y[kToolWay], y[kToolSpeed], y[kYielded]}; }
  StruckTool::Striker striker(const State& y) const noexcept;
  Acting acting(const State& y, double time) const noexcept;
  void rate(const State& y, State& slope, double time) const noexcept;
  int contacts(const State& y) const noexcept;
  void step();
  State stateAt(double time) const;
  void accept(const State& next, const State& slope, double dt, int contacts);
  void passDeadCentre() noexcept;
  void followBlow();
  void putToolBack();

  MachineSettings settings_;
  ElasticLinks links_;
  RodSpring rod_;
  StruckTool struck_;
  State now_{}, slope_{};            ///< at the end of the last step
  State before_{}, before_slope_{};  ///< at its beginning
  double time_{}, before_time_{}, longest_step_, next_step_;
  double asked_{};  ///< requested time, within the last step [s]
  State view_{};    ///< state at that time
  std::int64_t view_turn_{};
  int contacts_{};
  std::int64_t turn_{};
  double put_back_{}, view_put_back_{};  ///< energy removed by resetting the tool [J]

  struct Turn {
    double start{}, impulse_x{}, impulse_z{};  ///< [s], [N s]
    double peak{};                             ///< [N]
    bool whole{};
  } current_;
  BlowFollower follower_;
};

}  // namespace hammer_loads::simulation
