/// Hydraulically driven crank-rocker hammer at work, integrated with small steps: the truth for estimates.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/moving_links.h"
#include "hammer_loads/simulation/normal_noise.h"

namespace hammer_loads::simulation {

/// Machine at one instant. Loads ON the hull about D, axes of hammer_hull.
struct CrankTruth {
  double time{};              ///< since start [s]
  std::int64_t turn{};        ///< dead centres passed
  double angle{};             ///< in [0, 2 pi) [rad]
  double speed{};             ///< [rad/s]
  double twist{};             ///< angle of the motor, where the encoder sits, less the crank's [rad]
  double motor_speed{};       ///< [rad/s]
  bool mirrored{};            ///< the rocker passed the dead centre without a blow and has not returned
  double acceleration{};      ///< [rad/s2]
  double pressure{};          ///< at the motor [Pa]
  double hull_pitch{};        ///< [rad]
  Load load;                  ///< BY the links, weight included
  double drive_reaction_y{};  ///< BY motor and flywheel about +y [N m]
  double rocker_angle{};      ///< psi [rad]; of an elastic machine alone, as what follows
  double rocker_speed{};      ///< psi' [rad/s]
  double rod_force{};         ///< compression > 0 [N]
  double tool_force{};        ///< along +z BY the tool ON the rocker [N]
  double retainer_force{};    ///< along +z BY the hull's retainer ON the rocker [N]

  bool touches() const { return tool_force != 0.0 || retainer_force != 0.0; }  ///< the rocker tool or retainer
};

/// One blow and the turn that it ended.
struct BlowTruth {
  double time{};         ///< since start [s]
  double crank_speed{};  ///< [rad/s]
  Strike strike;
  double turn_period{};        ///< [s]
  double turn_peak_force_z{};  ///< largest Fz of the turn [N]
  double turn_impulse_x{};     ///< integral of Fx over the turn [N s]
  double turn_impulse_z{};     ///< [N s]
  bool whole_turn{};           ///< true if it began with a blow and the crank never turned back
  double contact{};            ///< time that all its touches lasted [s]; of an elastic machine alone, as what follows
  double retainer_impulse{};   ///< along +z BY the hull's retainer ON the rocker [N s]
  int touches{};               ///< number of touches of tool and retainer
};

/// Energy balance since the start [J]. It is tested:
/// kinetic + blows + losses + stops = motor - friction + weight;  stored = supply - motor - valves.
struct EnergyAccount {
  double motor{};     ///< work of the pressure on the shaft
  double friction{};  ///< dissipated by friction, >= 0
  double weight{};    ///< work of the links' weight
  double supply{};    ///< hydraulic work of the pump flow
  double valves{};    ///< lost in leakage, relief and bypass
  double blows{};     ///< transferred to the tool
  double losses{};    ///< in linkage and crank at the blows
  double stops{};     ///< lost when the crank, turning back, comes to rest on the tool
  double kinetic{};   ///< present energy of links and drive, with the twist of the coupling
  double stored{};    ///< in the compliance now
};

/// State crank angle, speed, pressure: w' = (tau + weight - J'/2 w^2)/(Jc + J), p' = (flow - D w - losses)/C.
/// The blow is located within a step to rounding; crank speed is continuous there unless settings.blow states
/// otherwise. A crank that turns back onto the tool stops there until the torque is positive again, since a rebound
/// would need a restitution above 1. Without a tool the rocker passes onto the mirrored branch and returns a turn
/// later. Neglects: acceleration of the hull by boom motion and by the load itself, elasticity of links. Runge-Kutta of
/// order 4, steps of at most settings.step, shorter where a coupling swings.
class WorkingMachine {
 public:
  /// Throws std::invalid_argument when the hammer's linkage is impossible.
  explicit WorkingMachine(const MachineSettings& settings);

  /// time >= now [s].
  void advanceTo(double time) noexcept;
  CrankTruth truth() const noexcept;
  EnergyAccount energy() const noexcept;
  /// Hands over the blows since the last call.
  std::vector<BlowTruth> takeBlows();

 private:
  enum Index {
    kOffset,
    kSpeed,
    kPressure,
    kImpulseX,
    kImpulseZ,
    kMotor,
    kFriction,
    kWeight,
    kSupply,
    kValves,
    kTwist,       // of the coupling
    kMotorSpeed,  // stays 0 with a rigid coupling
    kSize
  };
  using Vector = std::array<double, kSize>;
  /// Inputs from outside at a time.
  struct Outside {
    double time{};  ///< [s]
    Gravity gravity;
    double flow{};  ///< flow of the pump [m3/s]
  };
  struct State {
    Outside outside;
    bool before_blow{};
    bool resting{};   ///< on the tool, turned back
    bool mirrored{};  ///< rocker beyond the tool's place
    bool met{};       ///< the early tool, in this turn
    Vector y{};
    TurnAngle angle() const noexcept { return {y[kOffset], before_blow, mirrored}; }
  };
  /// Properties of the next blow.
  struct NextBlow {
    double restitution{};
    bool blank{};
  };

  bool flexible() const noexcept { return settings_.drive.coupling_frequency > 0.0; }
  double netTorque(const State& state) const noexcept;
  double shaftTorque(const State& state) const noexcept;
  double eventOffset() const noexcept;
  Outside outsideAt(double time) const noexcept;
  Vector rate(const State& state) const noexcept;
  State step(double dt) const noexcept;
  double timeTo(double offset, double dt) const noexcept;
  void accept(const State& next);
  void meetEarlyTool();
  void passDeadCentre();
  void blow();
  void drawBlow() noexcept;
  void followForce() noexcept;
  void beginTurn(bool whole) noexcept;

  MachineSettings settings_;
  MovingLinks links_;
  State now_;
  Vector rate_{};  ///< at now_
  std::int64_t turn_{};
  double blow_energy_{}, loss_energy_{}, stop_energy_{};
  double released_{-1.0};  ///< from the tool, last time [s]
  std::vector<BlowTruth> blows_;
  double crank_side_inertia_, motor_inertia_{}, stiffness_{}, damping_{};  ///< about the coupling
  double step_;                                                            ///< longest [s]
  NormalNoise draws_;
  NextBlow next_blow_;
  std::optional<Strike> early_;  ///< strike of this revolution, at early_time_
  double early_time_{}, early_crank_speed_{};

  struct Turn {
    double start_time{}, impulse_x{}, impulse_z{};  ///< impulses at its beginning
    double peak{};
    double time[2]{}, force[2]{};  ///< the two last points, for the parabola
    int points{};
    bool whole{};
  } current_;
};

}  // namespace hammer_loads::simulation
