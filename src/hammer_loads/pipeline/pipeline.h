/// Pipeline from samples to loads, which connects all parts. It is independent of ROS and clocks: time is that of the
/// header stamps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/hammer/displaced_links.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/crank_checks.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/elastic_follower.h"
#include "hammer_loads/pipeline/hull_state.h"
#include "hammer_loads/pipeline/misuse.h"
#include "hammer_loads/pipeline/rod_ring.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/pipeline/turn_follower.h"
#include "hammer_loads/pipeline/unknown_force.h"
#include "hammer_loads/pipeline/wrench_sampler.h"
#include "hammer_loads/pipeline/zero_watch.h"

namespace hammer_loads {

/// Pipeline of the crank, the hull's state, the revolution, the boom and the outputs, in this order. Its results depend
/// on inputs and settings alone.
class Pipeline {
 public:
  /// boom: empty if its loads are not wanted. counts: initial counts.
  Pipeline(const Mechanism& mechanism, const PipelineSettings& settings, const std::optional<Boom>& boom = {},
           const SampleCounts& counts = {});
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Takes a message of boom joints, any subset in any order: angles [rad], speeds [rad/s] or none. Returns true if any
  /// was of use.
  bool boomJoints(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                  const std::vector<double>& velocities) noexcept;
  /// Takes a reading of the hull's IMU; used with hull_motion imu and boom_stiffness identified. Returns the reason if
  /// it was refused.
  std::optional<ImuRefusal> hullImu(StampNs stamp, const ImuReading& reading) noexcept {
    return hull_.imu(stamp, reading);
  }
  /// Takes the gauge pressure [Pa] in a chamber of a cylinder of the boom, index as in Boom::cylinders(). Returns true
  /// if it was accepted.
  bool cylinderPressure(StampNs stamp, std::size_t cylinder, Chamber chamber, double pressure) noexcept {
    return boom_ && boom_->pressure(stamp, cylinder, chamber, pressure);
  }
  /// Processes a crank message in JointState's terms, in which it finds the crank joint.
  const SampleResult& crankJoint(StampNs stamp, const std::vector<std::string>& names,
                                 const std::vector<double>& positions, const std::vector<double>& velocities) noexcept;
  /// Processes a crank sample. The result is valid until the next call. No allocation.
  const SampleResult& crankSample(StampNs header, const CrankSample& measured) noexcept;

  /// Ends the run: a blow that is still being measured becomes one of the result's ends, with the present estimate.
  const SampleResult& end() noexcept;

  const SampleResult& result() const noexcept { return result_; }  ///< result of the last sample
  /// Returns the standard deviations of the wrench within the step of the last sample, see WrenchSampler.
  HullDeviation stepDeviation(double time, const CrankEstimate& crank) const noexcept {
    return sampler_.deviation(time, crank, result_);
  }
  /// Returns another schedule of the wrench: its means at a rate [Hz]. Refers to the pipeline.
  WrenchSampler meansAt(double rate) const;
  /// Appends a schedule's outputs up to the last sample, which was accepted. Call once per sample.
  void sample(WrenchSampler& sampler, std::vector<WrenchOutput>& outputs) const noexcept;
  SampleCounts counts() const noexcept;
  const HullModel& model() const noexcept { return model_; }
  const CrankFollower& crank() const noexcept { return crank_; }
  /// Returns the names of the hammer's columns in SampleResult::load_columns, which follow those of the sensor.
  std::vector<std::string> hammerColumns() const { return columns_.names(); }
  const CrankTrust& crankTrust() const noexcept { return trust_; }
  const ZeroWatch& zeroWatch() const noexcept { return zero_; }
  const ElasticFollower& elastic() const noexcept { return elastic_; }
  const UnknownForce& unknownForce() const noexcept { return unknown_; }
  const HullState& hull() const noexcept { return hull_; }
  const std::optional<BoomFollower>& boom() const noexcept { return boom_; }
  const PipelineSettings& settings() const noexcept { return settings_; }

 private:
  const SampleResult& refuse(Refusal refusal) noexcept;
  const SampleResult& withhold(Refusal refusal) noexcept;
  void restart(bool revised) noexcept;
  void follow(CrankFollower::Outcome outcome) noexcept;
  std::optional<Refusal> whyWithheld() noexcept;
  Eigen::Matrix3d contactCovariance(const LinkMotion& links, const DriveReaction& drive) const noexcept;
  Eigen::Matrix3d zeroCovariance(const DriveReaction& drive) const noexcept;
  ElasticFollower::RodLoads computeDeviations(const LinksForGradient& links, const DriveReaction& drive) noexcept;
  void fill(const LinksForGradient& links, const DriveReaction& drive, const ElasticFollower::RodLoads& rod) noexcept;
  double speedScale() const noexcept;
  bool isPlausible(const HullWrench& wrench) const noexcept;
  bool isKnown() const noexcept;
  void followTrust(CrankFollower::Outcome outcome) noexcept;
  void hullMovedAtBlow() noexcept;
  double stampNoise() const noexcept;
  CrankLead crankLead(double speed) const noexcept;
  void followBoom(const LinksForGradient& links, const DriveReaction& drive) noexcept;
  void followMisuse() noexcept;
  void passBlows() noexcept;
  void followHull() noexcept;
  void advanceBoom(const WrenchHistory& step) noexcept;

  Mechanism mechanism_;
  PipelineSettings settings_;
  HullModel model_;
  WrenchColumns columns_;
  DisplacedLinks displaced_links_;
  CrankFollower crank_;
  CrankTrust trust_;
  ZeroWatch zero_;
  HullState hull_;
  RodRing rod_;
  UnknownForce unknown_;
  ElasticFollower elastic_;
  TurnFollower turn_;
  MisuseFollower misuse_;
  WrenchSampler sampler_;
  std::optional<BoomFollower> boom_;
  NearBlow near_blow_;
  double nominal_force_;  ///< peak of Fz at turn_rate_Hz and constant speed [N]; see isPlausible()
  double peak_at_speed_;  ///< largest component of the force there [N]
  bool settled_{};        ///< the last sample's estimate is accurate enough to be published, independent of CrankTrust
  bool boom_follows_{};   ///< the boom has had every step since the last restart
  SampleCounts counts_;
  SampleResult result_;
};

}  // namespace hammer_loads
