/// Readings of a simulated machine's sensors: a whole session in memory, or step by step.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <variant>
#include <vector>

#include "hammer_loads/simulation/elastic_machine.h"
#include "hammer_loads/simulation/hammer_on_boom.h"
#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

/// First-order low-pass lag y' = u - y, which starts at rest with y = u. It is exact for u linear between two inputs.
class LowPass {
 public:
  /// lag [s], >= 0; with 0, y = u.
  explicit LowPass(double lag) noexcept : lag_(lag) {}

  /// Updates the output with the input at `time` [s], which must not precede the last one.
  void follow(double time, double input) noexcept {
    const double dt = time - time_;
    if (!begun_ || !(lag_ > 0.0)) {
      output_ = input;
    } else if (dt > 0.0) {
      const double behind = lag_ * (input - input_) / dt;  // lag of the steady response to a ramp
      output_ = input - behind + (output_ - input_ + behind) * std::exp(-dt / lag_);
    }
    begun_ = true;
    time_ = time;
    input_ = input;
  }
  double output() const noexcept { return output_; }
  bool isOn() const noexcept { return lag_ > 0.0; }

 private:
  double lag_;
  bool begun_{};
  double time_{}, input_{}, output_{};
};

/// Angle and speed indicated by the encoder, accumulated over revolutions.
struct EncoderReading {
  double angle{}, speed{};  ///< [rad], [rad/s]
};

/// One message on `crank`.
struct CrankReading {
  std::int64_t stamp{};         ///< [ns]
  double angle{};               ///< [rad]
  std::optional<double> speed;  ///< [rad/s]
};

/// One message on `joint_states`; order of kBoomJoints.
struct JointReading {
  std::int64_t stamp{};              ///< [ns]
  std::array<double, 4> position{};  ///< [rad]
  std::array<double, 4> velocity{};  ///< [rad/s]
};

/// One message on `hull_imu`, in the unit's axes.
struct HullImuReading {
  std::int64_t stamp{};                    ///< [ns]
  std::array<double, 3> specific_force{};  ///< acceleration less gravity [m/s2]
  std::array<double, 3> rate{};            ///< [rad/s]
};

/// Messages below `cylinder_pressures` at one instant; order of kBoomCylinders.
struct PressureReading {
  std::int64_t stamp{};                 ///< [ns]
  std::array<double, 3> bore{}, rod{};  ///< gauge [Pa]
};

struct Session {
  std::vector<CrankReading> crank;  ///< in the order of arrival
  std::vector<CrankTruth> truth;    ///< one per crank reading; its instant is stated by the producing function
  std::vector<double> taken;        ///< instants of the crank readings [s since start]
  std::vector<JointReading> joints;
  std::vector<HullImuReading> imu;
  std::vector<PressureReading> pressures;
  std::vector<BlowTruth> blows;
  std::vector<OnBoomTruth> on_boom;  ///< truth of a hull on its boom, at the instants `taken`
};

/// Runs the machine, with its hull at rest or on its boom, and reads its sensors. Equal settings give equal readings
/// for any division of the time into calls. The truth is that at the instants at which readings are taken.
class SessionStream {
 public:
  /// Throws std::invalid_argument when the hammer's linkage is impossible.
  explicit SessionStream(const MachineSettings& settings);

  /// Appends everything up to and including `time` [s since start].
  void advanceTo(double time, Session& session);

 private:
  /// A sample that waits for the last one of its burst.
  struct Taken {
    CrankReading reading;
    CrankTruth truth;
    std::optional<OnBoomTruth> on_boom;
    bool twice{};
  };
  /// A sensor that is read at equal intervals.
  struct Ticks {
    double first{}, rate{};  ///< [s], [Hz]; 0: never
    std::int64_t count{};
    double next() const noexcept;
  };

  void advanceMachine(double time);
  void moveTo(double time);
  void readTask(double time);
  EncoderReading shown(const CrankTruth& truth) noexcept;
  CrankTruth truth() const;
  void planSample() noexcept;
  void takeCrank(Session& session);
  void take(Session& session);
  CrankReading read(const CrankTruth& truth) noexcept;
  OnBoomSensors onBoomAt(double time);  ///< advances a hull on its boom and returns its sensors
  JointReading readJoints(double time);
  HullImuReading readImu(double time);
  PressureReading readPressures(double time);
  std::int64_t stampAt(double time) const noexcept;
  std::int64_t busStamp(double time, std::int64_t& last) noexcept;  ///< stamp of a message delayed by its bus

  MachineSettings settings_;
  std::variant<WorkingMachine, ElasticMachine, HammerOnBoom> machine_;
  NormalNoise noise_;
  NormalNoise message_draws_, loss_draws_, joint_noise_, imu_noise_, pressure_noise_;
  NormalNoise bus_draws_, driver_draws_, boom_driver_draws_;
  LowPass angle_, speed_;            ///< low-passes of the encoder
  std::deque<EncoderReading> task_;  ///< readings in the controller's last mean
  std::int64_t tasks_{};             ///< number of the controller's readings so far
  std::optional<double> held_;       ///< angle of an encoder with hysteresis [rad]
  std::array<LowPass, 6> hoses_;     ///< low-passes of bore and rod sides
  double sensor_time_{};             ///< time up to which the low-passes are updated [s]
  std::int64_t last_stamp_{}, last_joints_{}, last_imu_{}, last_pressures_{};
  std::vector<Taken> burst_;
  std::int64_t samples_{};
  Ticks joints_, imu_, pressures_;
  double next_sample_{}, stamp_error_{}, speed_error_{};
};

/// Returns the machine's state at any instants [s since start, >= 0], in their order.
std::vector<CrankTruth> truthAt(const MachineSettings& settings, const std::vector<double>& times);

/// Returns the whole session of settings.duration. The truth is that at the header stamps less the sensor's latency,
/// which a user takes as the sampling instants.
Session recordSession(const MachineSettings& settings);

}  // namespace hammer_loads::simulation
