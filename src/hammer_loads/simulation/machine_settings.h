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

/// A driver polls its device by a clock of its own and stamps when it finds a reading: stamps are the next tick of that
/// clock, so that their lateness is a sawtooth of the beat between the two clocks. A few come much later.
struct DriverStamps {
  double tick{};        ///< period of the driver's clock [s]; 0: each reading is stamped at once
  double late_share{};  ///< part of the stamps that are late beside that [-], in [0, 1]
  double late_mean{};   ///< mean of their lateness, which is distributed exponentially [s]

  bool areExact() const noexcept { return tick == 0.0 && late_share == 0.0; }
  /// Lateness of the stamp of a reading taken at `time` [s]. Always consumes two numbers of the generator.
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
  double relief_pressure{};     ///< relief valve opens [Pa]
  double relief_slope{};        ///< relief flow per pressure above it [m3/(s Pa)]
  double coulomb_friction{};    ///< on the shaft [N m]
  double viscous_friction{};    ///< on the shaft [N m s/rad]
  double friction_speed{};      ///< Coulomb friction is tanh(w/this) [rad/s], > 0
  double inertia{};             ///< Jc: motor, flywheel [kg m2], > 0

  double flow{};                   ///< pump at work [m3/s]
  double flow_variation{};         ///< slow variation of it, relative to flow [-]
  double flow_variation_period{};  ///< [s], > 0
  double ripple{};                 ///< fast variation (pump pistons), relative to flow [-]
  double ripple_frequency{};       ///< [Hz]
  double start_time{};             ///< flow begins to rise [s]
  double start_ramp{};             ///< and is whole after this long [s], > 0
  double stop_time{};              ///< flow begins to fall and a bypass opens [s]; after the end: never
  double stop_ramp{};              ///< [s], > 0
  double bypass{};                 ///< open bypass: flow per pressure [m3/(s Pa)]

  double coupling_frequency{};  ///< natural frequency of the flexible coupling between motor and crank, both free [Hz];
                                ///< 0: rigid
  double motor_share{0.5};      ///< part of the inertia on the motor's side of the coupling [-], in (0, 1)
  double coupling_damping{};    ///< damping ratio of that mode [-]
};

/// Contact of rocker and tool. By default it is at the dead centre, and the crank keeps its speed.
struct BlowSettings {
  bool restitution_drawn{};      ///< else the one at which the crank keeps its speed
  double restitution_low{};      ///< drawn for each blow, uniform between these [-]
  double restitution_high{};     ///< [-]
  double crank_loss{};           ///< part of the crank's speed lost beside that at each blow [-], in [0, 1)
  double tool_early{};           ///< angle before the dead centre at which the rocker meets the tool [rad], in [0, 1]
  double early_tool_mass{50.0};  ///< mass that the rocker then takes along, at the striking point [kg], > 0
  double blank_share{};          ///< part of the blows that find no tool [-], in [0, 1]
};

/// Rod, pins and bearings in series, along the line of the pins.
struct RodSettings {
  double stiffness{};      ///< [N/m]; 0: rigid
  double damping_ratio{};  ///< damping ratio of an oscillator of 200 Hz on this spring [-]: damping = ratio
                           ///< stiffness/(200 pi Hz)
  double play{};           ///< free way of both pins together [m]
};

/// Targets of an elastic machine's rocker: a tool with mass that stands on rock, or the hull's retainer. By default a
/// blow lasts 0.34 ms and the rocker leaves with 0.16 of its speed, near that of the linkage there (model.md 2).
struct StrikeSettings {
  double tool_mass{40.0};           ///< [kg], > 0
  double contact_stiffness{1.2e9};  ///< between rocker and tool [N/m], > 0
  double contact_damping{
      0.07};                   ///< loss: the spring's force is multiplied by 1 + this times the speed of approach [s/m]
  double rock_stiffness{5e8};  ///< [N/m], > 0
  double rock_damping{0.05};   ///< loss, likewise [s/m]
  double rock_strength{2e5};   ///< the rock yields above this force [N], > 0
  double tool_late{};  ///< distance of the tool below its place at the dead centre; < 0: above, so that it is met early
                       ///< [m]
  double tool_spread{};                 ///< drawn for each turn, uniform within plus and minus this [m]
  double retainer_stiffness{};          ///< stiffness of the hull's retainer [N/m]; 0: none
  double retainer_gap{0.005};           ///< below the dead centre's place [m]
  double retainer_damping{0.05};        ///< loss, likewise [s/m]
  double no_tool_from{}, no_tool_to{};  ///< between them a turn that begins finds no tool [s]
};

/// amount [sin(n angle + phase) - sin(phase)] is added to the encoder's angle [rad].
struct Eccentricity {
  double amount{}, phase{};  ///< [rad]
};

constexpr double kNever = std::numeric_limits<double>::infinity();  ///< [s]

/// Crank encoder and the message that carries it.
struct CrankSensorSettings {
  double rate{};             ///< [Hz], > 0
  double jitter{};           ///< standard deviation of the instants of sampling [s]; at most 0.45 periods each
  double stamp_noise{};      ///< standard deviation of stamp against instant [s]; order may break if large
  DriverStamps driver;       ///< beside that noise
  bool stamps_late{};        ///< true if that noise only ever delays: its magnitude counts
  double stamp_step{};       ///< stamps are whole multiples of it, rounded down [s]; 0: nanoseconds
  double latency{};          ///< constant part of stamp less instant [s]
  int burst{1};              ///< number of samples that carry the stamp of their last one, >= 1
  bool stamps_ordered{};     ///< true if stamps never decrease: a late one delays those after it
  double duplicate_share{};  ///< part of the messages that come twice [-], in [0, 1]
  double loss_share{};       ///< part of the samples that are lost [-], in [0, 1)
  int counts{};              ///< per turn; angle = whole counts passed; 0: continuous
  bool unwound{};            ///< angle grows over the turns instead of staying in [0, 2 pi)
  bool speed{true};          ///< speed is measured too
  double speed_noise{};      ///< standard deviation [rad/s]
  double speed_lag{};        ///< time constant of a low-pass of first order on the measured speed [s]
  double speed_scale{1.0};   ///< measured over true speed [-], > 0
  double angle_lag{};  ///< time constant of a low-pass of first order on the encoder's angle, before it is counted [s]
  double zero{};       ///< reading at the blow [rad]
  int direction{1};    ///< 1 or -1
  double ratio{1.0};   ///< encoder turns per crank turn [-], > 0
  Eccentricity eccentricity[2];  ///< once and twice a turn
  double hysteresis{};           ///< play of the shown angle when the direction of rotation reverses [rad]
  double task_period{};          ///< period of a controller that reads the encoder and sends its last mean [s]; 0: none
  int task_mean{1};              ///< readings of that controller in one mean, >= 1
  struct Interval {
    double from{}, to{};  ///< [s]
  };
  std::vector<Interval> drop_outs;  ///< instants in [from, to) give no sample
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

/// Inertial unit on a hull that hangs on its boom: place from the rocker's pivot D, axes the hull's, turned about y.
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
  double preload{};   ///< in the unloaded chamber at rest [Pa]
  double hose_lag{};  ///< time constant of the low-pass of first order that is the sensor's hose [s]; 0: none
  double count{};     ///< resolution of the sensor's number [Pa]; 0: any
};

/// The ground under the tool: a unilateral spring with damping along the tool at the hull's foot. It recedes as fast as
/// the operator advances the hull.
struct RockSettings {
  double stiffness{};        ///< stiffness of rock and tool [N/m]; 0: no rock, the hull hangs free
  double damping{};          ///< the spring's force counts 1 + this times the speed of going down [s/m]
  double hold_down_force{};  ///< force of the operator on the hull before it works [N], >= 0
};

/// Seals of the boom's cylinders: against the rod's speed v, force = (constant P + friction |F|) way, F the oil's
/// force, P the push at 14 MPa. With s = 1 + breakaway e^-(v/stribeck)^2, way = s tanh(v/smooth). Seals that yield
/// before they slide have way = z/presliding, z' = v - |v| z/(presliding s) (model of Dahl with the curve of Stribeck).
struct SealSettings {
  double friction{};             ///< [-]
  double constant{};             ///< [-]; a loader crane's: 0.010 to 0.016
  double breakaway{0.4};         ///< more of it near standstill [-], >= 0
  double stribeck_speed{0.004};  ///< [m/s], > 0
  double smooth_speed{5e-4};     ///< below it the force fades through zero [m/s], > 0
  double presliding{};           ///< displacement before the seals slide [m]; 0: none

  static constexpr double kReliefPressure = 14e6;  ///< [Pa]
  bool rubs() const { return friction > 0.0 || constant > 0.0; }
  double nearStandstill(double speed) const {  ///< s
    return 1.0 + breakaway * std::exp(-(speed / stribeck_speed) * (speed / stribeck_speed));
  }
};

/// Hull and boom that move on the oil of their cylinders; all dimensions in oil_boom.h.
struct OnBoomSettings {
  bool on{};                                          ///< else the hull has no motion but its pitch, and no sensors
  double oil_stiffness{1.0};                          ///< over that of a bulk modulus of 1e9 Pa [-], > 0
  std::array<double, 3> cylinder_oil{1.0, 1.0, 1.0};  ///< each cylinder's over that [-], > 0
  double air{};                                       ///< in the oil, its share of the volume at ambient pressure [-]
  double leak{};               ///< past each piston [m3/(Pa s)]; the operator makes up for the steady part
  double pin_play{};           ///< joint clearance of each cylinder's pins together, along its rod [m]
  double bending_frequency{};  ///< natural frequency of boom and arm, each alone with what it carries, cylinders stiff
                               ///< [Hz]; 0: rigid
  double bending_damping{0.02};  ///< damping ratio of the bending [-]
  double damping{0.05};          ///< ratio of every mode [-], in [0, 1)
  double step{4e-4};             ///< longest integration step [s], > 0
  SealSettings seals;
  RockSettings rock;
  HullImuSensor imu;
  PressureSensors pressures;
  double bus_delay{};  ///< messages but the crank's wait for their bus, and are stamped, up to that late [s]

  bool isPlain() const noexcept { return air == 0.0 && leak == 0.0 && pin_play == 0.0; }
};

/// Order of the boom's joints in this folder; hull pitch = boom + arm + hammer (contract).
constexpr std::array<const char*, 4> kBoomJoints{"swing_joint", "boom_joint", "arm_joint", "hammer_joint"};

/// Random numbers of the blows, independent of the sensors' noise.
constexpr std::uint64_t kBlowSeed = 0x9e3779b97f4a7c15;

struct MachineSettings {
  HammerParameters hammer;      ///< drive_inertia in it is not used: see drive.inertia
  Level level{Level::kRocker};  ///< level that decides which links have mass
  DriveSettings drive;
  BlowSettings blow;
  RodSettings rod;        ///< elastic: `strike` holds, and of `blow` blank_share alone
  StrikeSettings strike;  ///< contacts of a machine with an elastic rod
  CrankSensorSettings crank;
  std::array<JointMotion, 4> boom;
  OnBoomSettings on_boom;
  DriverStamps boom_stamps;    ///< stamps of all messages but the crank's
  double joint_rate{};         ///< rate of the boom joints' samples [Hz], > 0
  double joint_count{};        ///< resolution of their sensors' numbers [rad]; 0: any
  double joint_noise{};        ///< standard deviation of their angles [rad]
  double joint_speed_noise{};  ///< and of their speeds [rad/s]
  double gravity{};            ///< [m/s2]
  double start_angle{};        ///< crank at t = 0, at rest [rad], in (0, 2 pi)
  double duration{};           ///< [s]
  double step{};               ///< longest integration step [s], > 0
  std::int64_t start_stamp{};  ///< header stamp of t = 0 [ns]
  std::uint64_t seed{};        ///< seed of all noise
};

/// Pitch of a hull whose boom follows the operator exactly, at a time since the start [rad].
double hullPitch(const MachineSettings& settings, double time) noexcept;
/// Gravity in the axes of that hull [m/s2].
Gravity hullGravity(const MachineSettings& settings, double time) noexcept;

/// A hammer MO-100 at 1000 J on an excavator's boom: works from about 2 s until 2 s before the end of 20 s.
MachineSettings workingMo100();

}  // namespace hammer_loads::simulation
