/// Samples in, loads out: the one place where the parts meet. No ROS, no clock: time is the header stamps'.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/crank/crank_tracker.h"
#include "hammer_loads/hammer/blow.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/crank_step.h"
#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/hull_imu.h"
#include "hammer_loads/pipeline/hull_outputs.h"
#include "hammer_loads/pipeline/hull_pitch.h"
#include "hammer_loads/pipeline/intake.h"
#include "hammer_loads/pipeline/pending_blow.h"
#include "hammer_loads/pipeline/turn_recorder.h"
#include "hammer_loads/pipeline/unit_check.h"
#include "hammer_loads/settings/pipeline_settings.h"

namespace hammer_loads {

/// A blow and, if the turn before it was seen whole, its pulse.
struct TurnEnd {
  StampNs stamp{};       ///< instant of the blow, found between samples [ns]
  std::uint64_t turn{};  ///< blows since the start, 1 for the first
  RockerBlow blow;
  double mean_press_force{};  ///< tool impulse times blow rate [N]; NaN where the turn was not seen whole
  std::optional<HalfSinePulse> pulse;
};

/// What one crank sample gave.
struct Loads {
  StampNs stamp{};
  std::optional<Refusal> refusal;  ///< if set, crank and wrench are void (the turn ends are not)
  CrankEstimate crank;
  HullWrench wrench;        ///< at the sample
  const BoomState* boom{};  ///< null: no boom, or not wanted
  std::size_t turn_ends{};  ///< how many of `ends` are meant; more than one only for sparse samples
  std::array<TurnEnd, 4> ends;
};

/// Counts since the start.
struct IntakeCounts {
  std::uint64_t accepted{};
  std::array<std::uint64_t, static_cast<std::size_t>(Refusal::kCount)> refused{};
  std::uint64_t restarts{};  ///< drop-outs, jumps and time running back
};

/// Readings of the hull's IMU since the start.
struct ImuCounts {
  std::uint64_t accepted{};
  std::array<std::uint64_t, static_cast<std::size_t>(ImuRefusal::kCount)> refused{};
  std::uint64_t missed{};  ///< crank samples at which the hull's motion was not known: weight by pitch then
};

class Pipeline {
 public:
  /// boom: nothing where its loads are not wanted. counts: where they go on from.
  Pipeline(const Mechanism& mechanism, const PipelineSettings& settings, const std::optional<Boom>& boom = {},
           const IntakeCounts& counts = {});
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Whether turns (blows and pulses) shall be followed; what nobody wants is not computed. Default: yes.
  void wantTurns(bool wanted) noexcept { want_turns_ = wanted; }
  /// Whether the boom shall be followed. Default: yes, if there is one.
  void wantBoom(bool wanted) noexcept { want_boom_ = wanted; }

  /// A message of boom joints, any subset in any order: angles [rad], speeds [rad/s] or none. Whether any was of use.
  bool boomJoints(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                  const std::vector<double>& velocities) noexcept;
  /// A reading of the hull's IMU; used with hull_motion imu alone. Why it was refused, if it was.
  std::optional<ImuRefusal> hullImu(StampNs stamp, const ImuReading& reading) noexcept;
  /// A crank message in JointState's terms; finds the crank joint in it.
  const Loads& crankJoint(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                          const std::vector<double>& velocities) noexcept;
  /// A crank sample. The result is valid until the next call. No allocation.
  const Loads& crankSample(StampNs stamp, const CrankSample& sample) noexcept;
  /// The hull wrench as it is to be published: call after each sample until false. By default once per accepted sample.
  bool nextOutput(HullOutput& output) noexcept { return outputs_.next(output); }
  /// Of the output just taken. For a mean that of its end or, if less, what the momentum's at both ends allows.
  HullDeviation deviation(const HullOutput& output) noexcept;

  const IntakeCounts& counts() const noexcept { return counts_; }
  const UnitCheck& unitCheck() const noexcept { return unit_check_; }
  /// The crank's angle stands still while its speed goes on.
  bool angleIsFrozen() const noexcept { return intake_.angleIsFrozen(); }
  const std::optional<BoomFollower>& boom() const noexcept { return boom_; }
  const HullPitch& hullPitch() const noexcept { return hull_pitch_; }
  const CrankTracker& tracker() const noexcept { return *tracker_; }
  const Mechanism& mechanism() const noexcept { return mechanism_; }
  const HullMotion& hullMotion() const noexcept { return hull_; }  ///< at the last accepted sample
  /// The hull's motion at the last sample is known: always, unless IMU or boom were to tell it and did not.
  bool hullMotionKnown() const noexcept { return hull_known_; }
  const ImuCounts& imuCounts() const noexcept { return imu_counts_; }
  const PipelineSettings& settings() const noexcept { return settings_; }

 private:
  const Loads& refuse(Refusal refusal) noexcept;
  void restart() noexcept;
  bool settled() noexcept;
  void takePitch() noexcept;
  void predictHull(StampNs stamp) noexcept;
  void followBoom(StampNs stamp) noexcept;
  void followTurn() noexcept;
  void recordTo(double from, double to) noexcept;
  void endTurn(const CrankStep::Passage& passage) noexcept;
  void tellBlow() noexcept;
  TurnInstant instant(double time, const CrankEstimate& crank) const noexcept;

  Mechanism mechanism_;
  PipelineSettings settings_;
  HullModel hull_model_;
  std::unique_ptr<CrankTracker> tracker_;
  HullPitch hull_pitch_;
  HullImu imu_;
  ImuCounts imu_counts_;
  Gravity weight_;  ///< by the latest pitch, hull axes [m/s2]
  HullMotion hull_;
  bool hull_known_{true};
  UnitCheck unit_check_;
  std::optional<StampNs> last_raw_stamp_;  ///< of the last sample, taken or not
  StampNs latency_;  ///< of the crank's header stamps
  Intake intake_;
  CrankStep step_;
  HullOutputs outputs_;
  HullWrench last_momentum_deviation_;  ///< at the last output whose deviation was asked for
  std::optional<BoomFollower> boom_;
  bool boom_follows_{};  ///< the boom has been told of every step since the last restart
  IntakeCounts counts_;
  Loads loads_;
  TurnRecorder turn_;
  PendingBlow pending_;
  TurnEnd pending_end_;  ///< of the pending blow
  StampNs epoch_{};                   ///< first sample since the last beginning
  CrankPosition last_position_;       ///< at the last accepted sample
  std::optional<StampNs> last_blow_;  ///< if the turn since then was seen whole
  std::uint64_t turns_{};
  double peak_force_{};  ///< of the last whole turn [N], 0 before the first
  bool want_turns_{true}, want_boom_{true};
  bool unsettled_{};
  bool speed_measured_{};
  int samples_since_restart_{};
};

}  // namespace hammer_loads
