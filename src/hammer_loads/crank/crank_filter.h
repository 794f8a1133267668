/// Kalman filter on the mechanism: estimates angle, speed, acceleration, torque and drive inertia from crank samples.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "hammer_loads/crank/consistency.h"
#include "hammer_loads/crank/contact_hypothesis.h"
#include "hammer_loads/crank/crank_belief.h"
#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/crank/encoder.h"
#include "hammer_loads/crank/speed_trust.h"
#include "hammer_loads/crank/stamp_sequence.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/estimation/timing_noise.h"

namespace hammer_loads {

/// Assumptions of the filter about sensors and supply.
struct CrankFilterSettings {
  CrankSensor sensor;            ///< mounting of the encoder
  double angle_resolution{};     ///< encoder count [rad], >= 0; 0: identified from the readings
  double angle_noise{};          ///< standard deviation in addition to the count [rad], >= 0
  double timing_noise{};         ///< standard deviation of a stamp, first guess [s], >= 0
  double speed_noise{};          ///< standard deviation of a measured speed, first guess [rad/s], > 0
  double torque_walk{};          ///< random walk of the net torque [N m/sqrt(s)], > 0
  double speed_walk{};           ///< random walk of the speed [rad/s/sqrt(s)], > 0
  double inertia_walk{};         ///< relative random walk of the drive inertia [1/sqrt(s)], >= 0
  double initial_torque_std{};   ///< [N m], > 0
  double initial_inertia_std{};  ///< relative [-], >= 0
  double max_speed{};            ///< bound of an unknown speed [rad/s], > 0
  double blow_factor{1.0};       ///< a blow's factor on the crank's speed, first guess [-], > 0
  ConstantErrors::Vector constant_deviations{ConstantErrors::priors()};  ///< standard deviations, units of kUnknowns
  double zero_std{ConstantErrors::kUnknownZero};  ///< standard deviation of the encoder's zero at first [rad]
  double blow_std{0.25};  ///< standard deviation of blow_factor, first guess; restitution 0 to 0.3: 0.64 to 1.26 [-]
  // Prior: blow_std
};

/// Extended Kalman filter, state: angle, speed, net torque, drive inertia, factor of the last blow on the crank's
/// speed. advance() computes the step between samples and its linearisation, through the blow as well. Steps (1) to
/// (10) of model.md 6.
///
/// Identified beside the state: drive inertia within a few revolutions; encoder count, noise of measured speeds and
/// jitter of the stamps within some hundred samples, and with jitter the torque's walk; the factor of the blows within
/// ten blows; the law of the torque (SupplyLaw) within some ten revolutions.
///
/// An angle that contradicts the prediction inflates the filter's covariance. A supply that differs from a slow random
/// walk is therefore followed with less smoothing instead of being refused. An outlier is ignored once; a second one in
/// a row that agrees with it restarts the filter. Near the blow there are no outliers, since the tool may be met some
/// degrees early or take most of the speed.
class CrankFilter {
 public:
  /// drive_inertia: first guess [kg m2], > 0.
  CrankFilter(const ShaftModel& model, double drive_inertia, const CrankFilterSettings& settings);

  /// Sets weight and motion of the hull at the next sample. The step to it is predicted with the mean of this and the
  /// last sample's.
  void setHullMotion(const HullMotion& hull) noexcept;
  /// Sets the clock of the next sample: if a reading is ahead by whole intervals, samples were lost before it.
  void setClock(const SampleClock& clock) noexcept { clock_ = clock; }
  /// Sets the standard deviation of a common shift of all stamps [s], which the readings do not show.
  void setLatencyDeviation(double deviation) noexcept { stamps_off_ = deviation; }
  /// Sets the displacement of the crank from the estimate by an elastic connecting rod [rad], [rad/s], which is added
  /// to the uncertainty.
  void inflateByRod(double angle, double speed) noexcept;

  /// Starts at a sample; the identified constants of the machine are kept. jitter: that of the coming stamps [s]; if it
  /// exceeds the present one, the jitter is identified again.
  void start(const CrankSample& sample, double jitter = 0.0) noexcept;
  /// Updates by the next sample, dt > 0 [s] after the last accepted one. No allocation.
  Tracking update(double dt, const CrankSample& sample) noexcept;
  /// Estimate at the last accepted sample.
  CrankEstimate estimate() const noexcept { return estimateOf(load(), now_.state); }
  /// Estimate dt [s] after the last but one accepted sample, 0 <= dt <= step between the last two. Continuous in dt
  /// but for the acceleration at a blow; equals estimate() at the end. Only after kContinued.
  CrankEstimate between(double dt) const noexcept;
  /// Estimates at between(dt) by either sample alone; where they contradict each other, the estimate differs from both.
  /// Empty if one of the predictions diverges.
  std::optional<CrankPaths> pathsBetween(double dt) const noexcept;
  /// Uncertainty of between(dt). torque_part: part of the torque's deviation that counts, see
  /// PipelineSettings::torque_std_part.
  CrankUncertainty uncertaintyBetween(double dt, double torque_part) const noexcept;
  /// Uncertainty at the last accepted sample.
  CrankUncertainty uncertainty(double torque_part) const noexcept { return uncertaintyOf(now_, load(), torque_part); }
  /// Returns false while the speed is not known (first sample without one).
  bool hasSpeed() const noexcept { return has_speed_; }
  /// Returns false if the estimate requires an impossible torque, as with degrees instead of radians.
  bool isPlausible() const noexcept;
  /// Factor of the last blow on the crank's speed, by all samples since.
  BlowFactor blowFactor() const noexcept;
  /// Returns true while it is uncertain whether the last passage was a blow: the estimate may be on the wrong branch.
  bool isUncertain() const noexcept { return hypothesis_.isUncertain(); }
  /// Probability of the other branch: no blow where the estimate has one, or a blow where it has none.
  double otherBranch() const noexcept;
  /// Returns true if the last reading itself determines the side of the blow, by an encoder's edge and an exact stamp.
  bool readingShowsSide() const noexcept { return read_side_.has_value(); }
  /// One count of the angle sensor [rad], as far as known.
  double angleResolution() const noexcept { return encoder_.resolution(); }
  /// Jc: identified inertia that turns with the crank, without the links [kg m2]; 0 for a crank that is held at
  /// constant speed, whose holding torque is not known.
  double driveInertia() const noexcept {
    return now_.state.drive_inertia < kHeld * first_guess_ ? now_.state.drive_inertia : 0.0;
  }
  /// Time by which lost samples lengthen the last step beyond its stamps [s]; < 0: a counted loss occurred later.
  double lostTime() const noexcept { return lost_time_; }
  /// Returns true if the last reading excludes that the step was longer or shorter by an interval.
  bool countsIntervals() const noexcept { return counts_intervals_; }
  /// Number of slips of the encoder on its shaft since the beginning.
  int slips() const noexcept { return slip_.count(); }
  /// Increases the encoder's zero by this angle of the crank [rad] from the next sample on, where the estimate
  /// restarts.
  void moveZero(double angle) noexcept { zero_moves_ += angle; }
  /// See ConstantErrors::setZeroContradicted().
  void setZeroContradicted(bool contradicted) noexcept { errors_.setZeroContradicted(contradicted); }

  const ShaftState& state() const noexcept { return now_.state; }
  /// Estimate at the last accepted sample, as the filter computes it.
  const CrankBelief& belief() const noexcept { return now_; }
  /// Random walks of the next step.
  CrankWalks walks() const noexcept {
    return {roughness_.factor() * settings_.torque_walk, settings_.speed_walk, settings_.inertia_walk, supply_.law()};
  }
  double mostSpeed() const noexcept;  ///< from which on an estimate has diverged [rad/s]
  /// Factor by which variances are multiplied before they are published.
  double growth() const noexcept { return consistency_.growth(); }
  /// Covariance of (angle, speed, torque, logarithm of drive inertia, blow factor) at the last accepted sample, as the
  /// filter computes it. Published covariances are multiplied by the consistency where that is above 1.
  const ShaftMatrix& covariance() const noexcept { return now_.covariance; }
  const Encoder& encoder() const noexcept { return encoder_; }
  /// The last accepted sample with its noise.
  const WeighedSample& sample() const noexcept { return sample_; }
  /// Time after its stamp at which the prediction reaches the last angle [s].
  double instantOff() const noexcept { return instant_off_; }
  /// Logarithm of the likelihood of the last angle before the update, without a constant.
  double angleFit() const noexcept { return angle_fit_; }
  /// Identified noise of measured speeds [rad/s].
  double speedNoise() const noexcept { return std::sqrt(speed_variance_); }
  /// Part of the angles' lag that is subtracted from the readings.
  const AngleLag& angleLag() const noexcept { return angle_lag_; }
  /// Check of measured speeds, which decides whether they are used.
  const SpeedTrust& speedTrust() const noexcept { return speed_trust_; }
  double timingNoise() const noexcept { return timing_.deviation(); }  ///< identified noise of stamps [s]
  /// Returns true after enough samples that agree with the model; until then a wrong unit may be undetected. A crank in
  /// degrees has a consistency of 8 to 40.
  bool isProven() const noexcept { return consistency() < mismatch::kContradicts; }
  /// Mean of innovation^2 over its variance of the last some 500 samples: near 1 where readings and model agree; NaN
  /// before 200.
  double consistency() const noexcept { return consistency_.mean(); }
  /// Consistency in the half revolutions before the blow alone, the lesser of the last two. An elastic rod or a
  /// prolonged blow changes little there, so that a contradiction means another machine or another sensor.
  double strikeConsistency() const noexcept { return strike_consistency_.mean(); }
  /// Estimated errors of crank_zero_rad and of the eccentricity, updated once a revolution.
  const ConstantErrors& constantErrors() const noexcept { return errors_; }
  /// Slips of the encoder on its shaft that the filter has followed.
  const EncoderSlip& encoderSlip() const noexcept { return slip_; }
  /// Evidence of an elastic rod in the innovations, by place.
  const RodEvidence& rodEvidence() const noexcept { return rod_evidence_; }
  /// Standard deviation of the last reading [rad].
  double readingDeviation() const noexcept { return std::sqrt(sample_.angleVariance(now_.state.speed)); }
  /// Returns true after so many restarts that the model does not fit: contradictions are then followed slowly.
  bool isLost() const noexcept { return restart_load_ > kLost; }
  /// Returns true if the innovations remain far larger than expected for any drive inertia.
  bool isUnexplained() const noexcept { return contradictions_ > kOftenContradicted; }

 private:
  static constexpr double kLearnSpeed = kSlowCrank;
  static constexpr double kToolSeen = gate::kVeryRare;  ///< gate for contact with the tool
  static constexpr double kHeld = 10.0;                 ///< times the first guess: no drive is as heavy
  // Limit: kHeld
  static constexpr double kLost = 5.0, kOftenContradicted = 2.0;
  static constexpr double kSteps = 20.0;  ///< samples in the mean step
  // Numerical: kSteps

  /// Prediction to a sample, and its innovation.
  struct SampleStep {
    const CrankBelief& last;  ///< at the sample before
    WeighedSample sample;
    double dt{};      ///< [s]
    bool struck{};    ///< true if the step contains a blow
    double read{};    ///< angle before the lag is subtracted [rad]
    double behind{};  ///< subtractLag() [rad]
    Innovation innovation{};
  };
  std::optional<Tracking> followSensor(SampleStep& to) noexcept;
  std::optional<Tracking> judge(SampleStep& to) noexcept;
  Tracking accept(const SampleStep& to, double reading) noexcept;
  void countGrossInnovation(bool is_gross) noexcept;
  const CrankBelief& before() const noexcept { return earlier_[before_]; }
  /// Returns the last two samples and the step between them.
  BetweenSamples lastStep() const noexcept {
    return {model_, step_model_, before(), now_, before_hull_, now_hull_, step_, mostSpeed()};
  }
  CrankUncertainty uncertaintyOf(const CrankBelief& belief, const ShaftLoad& load, double torque_part) const noexcept;
  /// Returns the load at now_ with the latest motion of the hull.
  ShaftLoad load() const noexcept { return hull_moved_ ? model_(now_.state.position.angle) : load_; }
  WeighedSample weighed(const CrankSample& reading) noexcept;
  int predict(double dt, bool contact, CrankBelief& belief) const noexcept;
  bool isAtTool(double dt) const noexcept;
  bool meetsOtherBlow(double dt, const Innovation& angle, const WeighedSample& sample) noexcept;
  bool meetsTool(double dt, const Innovation& angle, const WeighedSample& sample) noexcept;
  bool isContradiction(double dt, const Innovation& innovation) const noexcept;
  Innovation withoutRod(double dt, Innovation innovation) const noexcept;
  std::optional<Tracking> contradict(const CrankBelief& last, double dt, const Innovation& innovation,
                                     const WeighedSample& sample) noexcept;
  void followLostTime(SampleStep& to) noexcept;
  void predictTo(SampleStep& to, double dt) noexcept;
  double timeLost(double dt, const Innovation& innovation) const noexcept;
  bool mayBeRod(const Innovation& innovation) const noexcept;
  bool mayHaveSlipped(const WeighedSample& sample, const Innovation& innovation) const noexcept;
  EncoderSlip::Step followSlip(double dt, const Innovation& innovation, WeighedSample& sample) noexcept;
  Tracking ignore(const CrankBelief& last, const Innovation& innovation) noexcept;
  bool correct(const CrankBelief& last, double dt, bool struck, const Innovation& innovation,
               const WeighedSample& sample, double reading) noexcept;
  void correctAngle(Innovation innovation) noexcept;
  void settleSide(const CrankBelief& last, double dt, const WeighedSample& sample, bool struck) noexcept;
  std::optional<Side> readSide(double reading) const noexcept;
  void applyReadSide(const CrankBelief& last, double dt, bool struck, const WeighedSample& sample,
                     double reading) noexcept;
  void undoBlow(const CrankBelief& last, double dt, const WeighedSample& sample) noexcept;
  void updateConsidered() noexcept;
  bool findLag() noexcept;
  bool applyZero() noexcept;
  double subtractLag(const CrankBelief& last, double dt, bool struck, double read,
                     WeighedSample& sample) const noexcept;
  bool usesSpeeds() noexcept;
  double speedJump(bool struck) const noexcept;
  void judgeSpeed(double dt, bool struck) noexcept;
  void correctSpeed(const WeighedSample& sample, double dt, bool struck) noexcept;
  void beginHypothesis(const CrankBelief& belief) noexcept;
  bool hypothesisExplains(double dt, const WeighedSample& sample) noexcept;
  void checkContact() noexcept;
  void learnFrom(const Innovation& innovation, double ratio) noexcept;
  void rememberBlow(const CrankBelief& last, double dt) noexcept;
  void learnSupply() noexcept;
  void checkInertia(double dt) noexcept;
  void forgetInertia() noexcept;
  void updateLoad() noexcept;
  Tracking begin(const WeighedSample& sample) noexcept;
  void anchor(const WeighedSample& sample) noexcept;
  double mostTorque() const noexcept;

  ShaftModel model_;        ///< with the latest motion of the hull
  ShaftModel step_model_;   ///< with its mean over the step between the last two samples
  HullMotion now_hull_;     ///< at the last sample
  HullMotion before_hull_;  ///< at the last but one sample
  CrankFilterSettings settings_;
  double first_guess_;      ///< first guess of the drive inertia [kg m2]
  double unlearn_after_{};  ///< time until the inertia may be discarded again [s]
  Encoder encoder_;
  WeighedSample sample_;
  double angle_fit_{};
  double instant_off_{};  ///< see instantOff()
  struct {
    double angle{}, speed{};  ///< [rad], [rad/s]
    bool followed{};
  } rod_;                    ///< inflateByRod() since the last sample
  bool rod_hides_branch_{};  ///< rod_.followed when the other branch was last tested
  TimingNoise timing_;
  SupplyRoughness roughness_;
  LearnedSupply supply_;
  Consistency consistency_;
  StrikeConsistency strike_consistency_;
  RodEvidence rod_evidence_;
  ConstantErrors errors_;
  BlowHistory blows_;
  CrankBelief now_;                     ///< at the last sample, corrected by it
  ShaftLoad load_;                      ///< load at load_angle_ with now_hull_
  CrankAngle load_angle_;               ///< angle of now_ after its last update
  bool hull_moved_{true};               ///< the hull's motion was set since then
  std::array<CrankBelief, 2> earlier_;  ///< at the last but one sample; the other is scratch
  std::size_t before_{};                ///< index of the former
  ShaftLoad before_load_;               ///< load at before(), with before_hull_
  double step_{};                       ///< between these two [s]
  ContactHypothesis hypothesis_;        ///< hypothesis with contact where now_ has none, or the other way round
  bool mirrored_{};                     ///< now_ had no contact and is on the mirrored branch
  double fit_{};                        ///< logarithm of the last sample's likelihood by now_
  double speed_variance_;               ///< identified variance of measured speeds [rad2/s2]
  EncoderSlip slip_;
  RunningMean<> usual_step_{kSteps};  ///< [s]
  SampleClock clock_;                 ///< clock of the coming sample
  bool counts_intervals_{};           ///< see countsIntervals()
  double lost_time_{};                ///< time of the last step beyond that by its stamps [s]
  double stamps_off_{};               ///< standard deviation of the common shift of all stamps [s]
  SpeedTrust speed_trust_;
  AngleLag angle_lag_;
  double zero_moves_{};                               ///< moveZero() since the last sample [rad]
  std::optional<SpeedTrust::Comparison> comparison_;  ///< witness of the last sample
  std::optional<Side> read_side_;                     ///< side of the blow that the last reading shows
  double outlier_{};                                  ///< innovation of the outlier just seen [rad], 0: none
  int unexplained_{};  ///< innovations beyond 5 deviations since one of the other sign; negative ones count down
  double gross_innovations_{};  ///< number of such innovations, decaying
  double restart_load_{};       ///< number of restarts, decaying within 2 s
  double contradictions_{};     ///< number of times that the inertia was doubted, decaying within 30 s
  bool speeds_wait_{};          ///< speeds are judged, but not used yet
  bool has_speed_{};
};

}  // namespace hammer_loads
