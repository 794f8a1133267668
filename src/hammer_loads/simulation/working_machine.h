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

/// State of the machine at one instant. Loads are ON the hull about D, in the axes of hammer_hull.
struct CrankTruth {
  double time{};              ///< since start [s]
  std::int64_t turn{};        ///< number of dead centres passed
  double angle{};             ///< in [0, 2 pi) [rad]
  double speed{};             ///< [rad/s]
  double twist{};             ///< angle of the motor, where the encoder sits, less the crank's [rad]
  double motor_speed{};       ///< [rad/s]
  bool mirrored{};            ///< the rocker passed the dead centre without a blow and has not returned
  double acceleration{};      ///< [rad/s2]
  double pressure{};          ///< at the motor [Pa]
  double hull_pitch{};        ///< [rad]
  Load load;                  ///< load BY the links, weight included
  double drive_reaction_y{};  ///< torque BY motor and flywheel about +y [N m]
  double rocker_angle{};      ///< psi [rad]; this and the members below only of an elastic machine
  double rocker_speed{};      ///< psi' [rad/s]
  double rod_force{};         ///< positive in compression [N]
  double tool_force{};        ///< force along +z BY the tool ON the rocker [N]
  double retainer_force{};
  bool touches() const { return tool_force != 0.0 || retainer_force != 0.0; }  ///< true if the rocker is in contact
};

/// One blow and the revolution that it ended.
struct BlowTruth {
  double time{};         ///< since start [s]
  double crank_speed{};  ///< [rad/s]
  Strike strike;
  double turn_period{};        ///< [s]
  double turn_peak_force_z{};  ///< largest Fz of the revolution [N]
  double turn_impulse_x{};     ///< integral of Fx over the revolution [N s]
  double turn_impulse_z{};     ///< integral of Fz over the revolution [N s]
  bool whole_turn{};           ///< true if it began with a blow and the crank never ran backwards
  double contact{};            ///< duration of all contacts [s]; this and the members below only of an elastic machine
  double retainer_impulse{};   ///< along +z BY the hull's retainer ON the rocker [N s]
  int touches{};               ///< number of contacts with tool and retainer
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
  double stops{};     ///< lost when the crank runs back and comes to rest on the tool
  double kinetic{};   ///< present energy of links and drive, including the twist of the coupling
  double stored{};    ///< present energy of the compliance
};

/// The state is crank angle, speed and pressure: w' = (tau + weight - J'/2 w^2)/(Jc + J), p' = (flow - D w - losses)/C.
/// The blow is located within a step to rounding; crank speed is continuous there unless settings.blow states
/// otherwise. A crank that runs back onto the tool stops there until the torque is positive again, since a rebound
/// would need a restitution above 1. Without a tool the rocker passes onto the mirrored branch and returns a revolution
/// later. Neglects: acceleration of the hull by boom motion and by the load itself, elasticity of links. Integration by
/// Runge-Kutta of order 4, with steps of at most settings.step and shorter ones for a flexible coupling.
class WorkingMachine {
 public:
  /// Throws std::invalid_argument when the hammer's linkage is impossible.
  explicit WorkingMachine(const MachineSettings& settings);

  /// time >= now [s].
  void advanceTo(double time) noexcept;
  CrankTruth truth() const noexcept;
  EnergyAccount energy() const noexcept;
  /// Removes and returns the blows since the last call.
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
    kTwist,       // twist of the coupling
    kMotorSpeed,  // stays 0 with a rigid coupling
    kSize
  };
  using Vector = std::array<double, kSize>;
  /// External inputs at a time.
  struct Outside {
    double time{};  ///< [s]
    Gravity gravity;
    double flow{};  ///< flow of the pump [m3/s]
  };
  struct State {
    Outside outside;
    bool before_blow{};
    bool resting{};   ///< at rest on the tool after the crank ran back
    bool mirrored{};  ///< rocker beyond the tool's position
    bool met{};       ///< the early tool was met in this revolution
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
  Vector rate_{};  ///< derivative of the state at now_
  std::int64_t turn_{};
  double blow_energy_{}, loss_energy_{}, stop_energy_{};
  double released_{-1.0};  ///< time of the last release from the tool [s]
  std::vector<BlowTruth> blows_;
  double crank_side_inertia_, motor_inertia_{}, stiffness_{}, damping_{};  ///< both sides of the coupling
  double step_;                                                            ///< longest step [s]
  NormalNoise draws_;
  NextBlow next_blow_;
  std::optional<Strike> early_;  ///< strike of this revolution, at early_time_
  double early_time_{}, early_crank_speed_{};

  struct Turn {
    double start_time{}, impulse_x{}, impulse_z{};  ///< impulses at its beginning
    double peak{};
    double time[2]{}, force[2]{};  ///< the last two points, for the parabola
    int points{};
    bool whole{};
  } current_;
};

}  // namespace hammer_loads::simulation
