/// Parameters of a simulated machine and its sensors.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/simulation/normal_noise.h"

namespace hammer_loads::simulation {

/// Stamps of a driver that polls its device with its own clock. A reading is stamped at the next tick of that clock, so
/// that the delay is a sawtooth at the beat of the two clocks. A few stamps come much later.
struct DriverStamps {
  double tick{};        ///< period of the driver's clock [s]; 0: each reading is stamped at once
  double late_share{};  ///< fraction of the stamps with an additional delay [-], in [0, 1]
  double late_mean{};   ///< mean of that delay, which is distributed exponentially [s]

  bool areExact() const noexcept { return tick == 0.0 && late_share == 0.0; }
  /// Returns the delay [s] of the stamp of a reading taken at `time` [s]. Always consumes two numbers of the generator.
  double lateness(double time, NormalNoise& draws) const noexcept {
    const double beat = tick > 0.0 ? tick * std::ceil(time / tick) - time : 0.0;
    const bool late = draws.uniform() < late_share;
    const double more = -late_mean * std::log(1.0 - draws.uniform());
    return beat + (late ? more : 0.0);
  }
};

/// Hydraulic drive: pump flow into a line with compliance, relief valve and leakage, motor on the crank's shaft.
struct DriveSettings {
  double motor_displacement{};  ///< [m3/rad], > 0
  double compliance{};          ///< compliance of line and accumulator: volume per pressure [m3/Pa], > 0
  double leakage{};             ///< [m3/(s Pa)]
  double relief_pressure{};     ///< opening pressure of the relief valve [Pa]
  double relief_slope{};        ///< relief flow per pressure above that [m3/(s Pa)]
  double coulomb_friction{};    ///< torque on the shaft [N m]
  double viscous_friction{};    ///< torque on the shaft per speed [N m s/rad]
  double friction_speed{};      ///< Coulomb friction follows tanh(w/friction_speed) [rad/s], > 0
  double inertia{};             ///< Jc: inertia of motor and flywheel [kg m2], > 0

  double flow{};                   ///< flow of the pump at work [m3/s]
  double flow_variation{};         ///< slow variation, relative to flow [-]
  double flow_variation_period{};  ///< period of that variation [s], > 0
  double ripple{};                 ///< fast variation (pump pistons), relative to flow [-]
  double ripple_frequency{};       ///< [Hz]
  double start_time{};             ///< time at which the flow begins to rise [s]
  double start_ramp{};             ///< duration of the rise to full flow [s], > 0
  double stop_time{};  ///< time at which the flow begins to fall and a bypass opens [s]; beyond the end: never
  double stop_ramp{};  ///< duration of the fall [s], > 0
  double bypass{};     ///< flow of the open bypass per pressure [m3/(s Pa)]

  double coupling_frequency{};  ///< natural frequency of the flexible coupling between motor and crank, both free [Hz];
                                ///< 0: rigid
  double motor_share{0.5};      ///< fraction of the inertia on the motor's side of the coupling [-], in (0, 1)
  double coupling_damping{};    ///< damping ratio of that mode [-]
};

/// Contact of rocker and tool. By default it is at the dead centre, and the crank keeps its speed.
struct BlowSettings {
  bool restitution_drawn{};      ///< true: drawn at random; false: the crank keeps its speed
  double restitution_low{};      ///< lower limit of the uniform draw for each blow [-]
  double restitution_high{};     ///< upper limit of it [-]
  double crank_loss{};           ///< fraction of the crank's speed lost in addition at each blow [-], in [0, 1)
  double tool_early{};           ///< angle before the dead centre at which the rocker meets the tool [rad], in [0, 1]
  double early_tool_mass{50.0};  ///< mass that the rocker then accelerates, at the striking point [kg], > 0
  double blank_share{};          ///< fraction of the blows that are blank firings [-], in [0, 1]
};

/// Rod, pins and bearings in series, along the line of the pins.
struct RodSettings {
  double stiffness{};      ///< [N/m]; 0: rigid
  double damping_ratio{};  ///< damping ratio of an oscillator of 200 Hz on this spring [-]: damping = ratio
                           ///< stiffness/(200 pi Hz)
  double play{};           ///< joint clearance of both pins together [m]
};

/// Targets of an elastic machine's rocker: a tool with mass that stands on rock, or the hull's retainer. By default a
/// blow lasts 0.34 ms and the rocker leaves with 0.16 of its speed, near that of the linkage there (model.md 2).
struct StrikeSettings {
  double tool_mass{40.0};           ///< [kg], > 0
  double contact_stiffness{1.2e9};  ///< between rocker and tool [N/m], > 0
  double contact_damping{
      0.07};                   ///< loss: the spring's force is multiplied by 1 + this times the speed of approach [s/m]
  double rock_stiffness{5e8};  ///< [N/m], > 0
  double rock_damping{0.05};   ///< loss factor of the rock [s/m]
  double rock_strength{2e5};   ///< the rock yields above this force [N], > 0
  double tool_late{};    ///< distance of the tool below its position at the dead centre [m]; < 0: above it, so that the
                         ///< contact is early
  double tool_spread{};  ///< half width of the uniform draw added to it for each revolution [m]
  double retainer_stiffness{};          ///< stiffness of the hull's retainer [N/m]; 0: none
  double retainer_gap{0.005};           ///< distance of the retainer below the position at the dead centre [m]
  double retainer_damping{0.05};        ///< loss factor of the retainer [s/m]
  double no_tool_from{}, no_tool_to{};  ///< revolutions that begin between these times have no tool [s]
};

/// Error amount [sin(n angle + phase) - sin(phase)] of the encoder's angle [rad].
struct Eccentricity {
  double amount{}, phase{};  ///< [rad]
};

constexpr double kNever = std::numeric_limits<double>::infinity();  ///< [s]

/// Crank encoder and the message that carries it.
struct CrankSensorSettings {
  double rate{};             ///< [Hz], > 0
  double jitter{};           ///< standard deviation of the sampling instants [s]; each is limited to 0.45 periods
  double stamp_noise{};      ///< standard deviation of stamp less instant [s]; a large one may break the order
  DriverStamps driver;       ///< delay in addition to that noise
  bool stamps_late{};        ///< true if the magnitude of that noise is used, so that it only delays
  double stamp_step{};       ///< resolution of the stamps, which are rounded down [s]; 0: nanoseconds
  double latency{};          ///< constant part of stamp less instant [s]
  int burst{1};              ///< number of samples that carry the stamp of their last one, >= 1
  bool stamps_ordered{};     ///< true if stamps always increase: a late one delays those after it
  double duplicate_share{};  ///< fraction of the messages that are sent twice [-], in [0, 1]
  double loss_share{};       ///< fraction of the samples that are lost [-], in [0, 1)
  int counts{};              ///< counts per revolution; the angle is rounded down to whole counts; 0: continuous
  bool unwound{};            ///< true if the angle accumulates over revolutions instead of staying in [0, 2 pi)
  bool speed{true};          ///< true if speed is measured too
  double speed_noise{};      ///< standard deviation [rad/s]
  double speed_lag{};        ///< time constant of a first-order low-pass on the measured speed [s]
  double speed_scale{1.0};   ///< ratio of measured to true speed [-], > 0
  double angle_lag{};  ///< time constant of a first-order low-pass on the encoder's angle, before it is counted [s]
  double zero{};       ///< reading at the blow [rad]
  int direction{1};    ///< 1 or -1
  double ratio{1.0};   ///< encoder revolutions per crank revolution [-], > 0
  Eccentricity eccentricity[2];  ///< errors once and twice per revolution
  double hysteresis{};           ///< lost motion of the indicated angle when the rotation reverses [rad]
  double task_period{};          ///< period of a controller that reads the encoder and sends a mean [s]; 0: none
  int task_mean{1};              ///< number of its last readings in the mean, >= 1
  struct Interval {
    double from{}, to{};  ///< [s]
  };
  std::vector<Interval> drop_outs;  ///< intervals [from, to) without samples
  /// Slip of the encoder on its shaft, or loss of its counter's reference, during an interval.
  struct Slip {
    double amount{};               ///< offset of the encoder's angle [rad]
    Interval during{0.0, kNever};  ///< [s]
  } slip;
};

/// One boom joint: mean + amplitude sin(2 pi t/period + phase).
struct JointMotion {
  double mean{};       ///< [rad]
  double amplitude{};  ///< [rad]
  double period{};     ///< [s], > 0
  double phase{};      ///< [rad]
};

double positionOf(const JointMotion& motion, double time) noexcept;  ///< [rad]
double velocityOf(const JointMotion& motion, double time) noexcept;  ///< [rad/s]

/// Inertial unit on a hull on its boom: position from the rocker's pivot D, axes of the hull, rotated about y.
struct HullImuSensor {
  double rate{};                ///< [Hz]; 0: none
  double x{}, z{}, pitch{};     ///< [m], [m], [rad]
  double acceleration_noise{};  ///< standard deviation of each axis [m/s2]
  double rate_noise{};          ///< standard deviation of each axis [rad/s]
};

/// Gauge pressure in both chambers of each cylinder.
struct PressureSensors {
  double rate{};      ///< [Hz]; 0: none
  double noise{};     ///< standard deviation [Pa]
  double preload{};   ///< pressure in the unloaded chamber at rest [Pa]
  double hose_lag{};  ///< time constant of the sensor's hose, a first-order low-pass [s]; 0: none
  double count{};     ///< resolution of the reading [Pa]; 0: continuous
};

/// The ground under the tool: a unilateral spring with damping along the tool at the hull's foot. It recedes as fast as
/// the operator advances the hull.
struct RockSettings {
  double stiffness{};        ///< stiffness of rock and tool [N/m]; 0: no rock, the hull hangs free
  double damping{};          ///< the spring's force is multiplied by 1 + this times the downward speed [s/m]
  double hold_down_force{};  ///< force of the operator on the hull before work begins [N], >= 0
};

/// Friction of the seals of the boom's cylinders. It opposes the rod's speed v: force = (constant P + friction |F|)
/// way. F is the oil's force, P the push at 14 MPa. With s = 1 + breakaway e^-(v/stribeck)^2, way = s tanh(v/smooth).
/// With presliding, way = z/presliding and z' = v - |v| z/(presliding s) (Dahl's model with the Stribeck curve).
struct SealSettings {
  double friction{};             ///< [-]
  double constant{};             ///< [-]; 0.010 to 0.016 for a loader crane
  double breakaway{0.4};         ///< relative increase near standstill [-], >= 0
  double stribeck_speed{0.004};  ///< [m/s], > 0
  double smooth_speed{5e-4};     ///< speed below which the force passes smoothly through zero [m/s], > 0
  double presliding{};           ///< displacement before the seals slide [m]; 0: none

  static constexpr double kReliefPressure = 14e6;  ///< [Pa]
  bool rubs() const { return friction > 0.0 || constant > 0.0; }
  double nearStandstill(double speed) const {  ///< s
    return 1.0 + breakaway * std::exp(-(speed / stribeck_speed) * (speed / stribeck_speed));
  }
};

/// Hull and boom supported by the oil of their cylinders; all dimensions are in oil_boom.h.
struct OnBoomSettings {
  bool on{};                                          ///< false: the hull moves in pitch only and has no sensors
  double oil_stiffness{1.0};                          ///< relative to a bulk modulus of 1e9 Pa [-], > 0
  std::array<double, 3> cylinder_oil{1.0, 1.0, 1.0};  ///< each cylinder's, relative to that [-], > 0
  double air{};                                       ///< volume fraction in the oil at ambient pressure [-]
  double leak{};                 ///< leakage past each piston [m3/(Pa s)]; the operator compensates the steady part
  double pin_play{};             ///< joint clearance of each cylinder's pins together, along its rod [m]
  double bending_frequency{};    ///< natural frequency of boom and arm, each alone with its load and on rigid cylinders
                                 ///< [Hz]; 0: rigid
  double bending_damping{0.02};  ///< damping ratio of the bending [-]
  double damping{0.05};          ///< damping ratio of every mode [-], in [0, 1)
  double step{4e-4};             ///< longest integration step [s], > 0
  SealSettings seals;
  RockSettings rock;
  HullImuSensor imu;
  PressureSensors pressures;
  double bus_delay{};  ///< largest delay by the bus of all messages but the crank's, contained in their stamps [s]

  bool isPlain() const noexcept { return air == 0.0 && leak == 0.0 && pin_play == 0.0; }
};

/// Order of the boom's joints in this folder; hull pitch = boom + arm + hammer (contract).
constexpr std::array<const char*, 4> kBoomJoints{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};

/// Seed of the blows' random numbers, which are independent of the sensors' noise.
constexpr std::uint64_t kBlowSeed = 0x9e3779b97f4a7c15;

struct MachineSettings {
  HammerParameters hammer;      ///< drive_inertia is not used; see drive.inertia
  Level level{Level::kRocker};  ///< level that decides which links have mass
  DriveSettings drive;
  BlowSettings blow;
  RodSettings rod;        ///< elastic rod: `strike` applies, and of `blow` only blank_share
  StrikeSettings strike;  ///< contacts of a machine with an elastic rod
  CrankSensorSettings crank;
  std::array<JointMotion, 4> boom;
  OnBoomSettings on_boom;
  DriverStamps boom_stamps;    ///< stamps of all messages but the crank's
  double joint_rate{};         ///< rate of the boom joints' samples [Hz], > 0
  double joint_count{};        ///< resolution of their angles [rad]; 0: continuous
  double joint_noise{};        ///< standard deviation of their angles [rad]
  double joint_speed_noise{};  ///< standard deviation of their speeds [rad/s]
  double gravity{};            ///< [m/s2]
  double start_angle{};        ///< crank angle at t = 0, at rest [rad], in (0, 2 pi)
  double duration{};           ///< [s]
  double step{};               ///< longest integration step [s], > 0
  std::int64_t start_stamp{};  ///< header stamp of t = 0 [ns]
  std::uint64_t seed{};        ///< seed of all noise
};

/// Returns the pitch [rad] of a hull whose boom follows the operator exactly, at a time since the start.
double hullPitch(const MachineSettings& settings, double time) noexcept;
/// Returns gravity in the axes of that hull [m/s2].
Gravity hullGravity(const MachineSettings& settings, double time) noexcept;

/// Returns a hammer MO-100 at 1000 J on an excavator's boom. It works from about 2 s to 18 s of a session of 20 s.
MachineSettings workingMo100();

}  // namespace hammer_loads::simulation
