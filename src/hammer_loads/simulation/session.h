/// What a simulated machine's sensors say: a whole session in memory, or step by step.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hammer_loads/simulation/machine_settings.h"
#include "hammer_loads/simulation/normal_noise.h"
#include "hammer_loads/simulation/working_machine.h"

namespace hammer_loads::simulation {

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

struct Session {
  std::vector<CrankReading> crank;
  std::vector<CrankTruth> truth;  ///< of the crank readings, one each
  std::vector<JointReading> joints;
  std::vector<BlowTruth> blows;
};

/// Runs the machine and reads its sensors. Same settings, same readings, however the time is cut into pieces.
class SessionStream {
 public:
  /// Throws std::invalid_argument when the hammer's linkage is impossible.
  explicit SessionStream(const MachineSettings& settings);

  /// Appends everything up to and including `time` [s since start].
  void advanceTo(double time, Session& session);
  const WorkingMachine& machine() const noexcept { return machine_; }

 private:
  void planSample() noexcept;
  CrankReading read(const CrankTruth& truth, double stamp_error, double speed_error) const noexcept;
  JointReading readJoints(double time) const noexcept;
  std::int64_t stampAt(double time) const noexcept;

  WorkingMachine machine_;
  NormalNoise noise_;
  std::int64_t samples_{}, joint_samples_{};
  double next_sample_{}, stamp_error_{}, speed_error_{};
};

/// The whole session of settings.duration.
Session recordSession(const MachineSettings& settings);

}  // namespace hammer_loads::simulation
