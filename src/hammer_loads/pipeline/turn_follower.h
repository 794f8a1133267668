/// Revolutions from blow to blow: their pulses, and their blows while they are measured.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/pipeline/blow_deviation.h"
#include "hammer_loads/pipeline/crank_follower.h"
#include "hammer_loads/pipeline/elastic_follower.h"
#include "hammer_loads/pipeline/hull_state.h"
#include "hammer_loads/pipeline/number_error.h"
#include "hammer_loads/pipeline/rod_ring.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// State of the mechanism at an instant of a revolution, as the recorder needs it.
struct TurnInstant {
  double time{};          ///< since any fixed origin [s]
  HullWrench wrench;      ///< weight included where the published wrench includes it
  LinkMomentum momentum;  ///< relative to the hull
  double weight_x{};      ///< weight within the wrench from here to the next instant [N]
  double weight_z{};      ///< weight along z [N]
};

/// Keeps the force and the exact impulses of the present revolution in a track of bounded size. A revolution with too
/// many instants loses every other point, but no impulse.
class TurnRecorder {
 public:
  TurnRecorder();

  /// Begins a revolution just after a blow.
  void begin(const TurnInstant& after_blow) noexcept;
  /// Replaces the momentum just after the blow by its better estimate.
  void correctBegin(const LinkMomentum& after_blow) noexcept;
  /// Discards the revolution's pulse, as the coming samples may not belong to it.
  void abandon() noexcept { recording_ = false; }
  bool recording() const noexcept { return recording_; }
  /// Returns the momentum that the load would have given a free hull by the blow that ended the last revolution [N s, N
  /// m s]. The hull returns in each revolution: its momentum has no trend and no mean, so that weight and blow are
  /// excluded. For a revolution that was not observed completely it is the momentum of the links before the blow.
  const LinkMomentum& swing() const noexcept { return swing_; }
  void add(const TurnInstant& instant) noexcept;
  /// Ends the revolution just before a blow; no pulse if it was not observed completely or never pushed the hull up.
  std::optional<HalfSinePulse> end(const TurnInstant& before_blow) noexcept;

 private:
  void thin() noexcept;

  std::vector<TurnPoint> points_;
  TurnInstant first_, last_;
  double weight_impulse_x_{}, weight_impulse_z_{};
  double momentum_way_z_{}, momentum_way_y_{};  ///< integrals of the momentum since the blow [N s2, N m s2]
  LinkMomentum swing_;
  std::size_t stride_{1}, skipped_{};
  bool recording_{};
};

/// Errors of impulses. An impulse is the difference of two momenta and the weight's between (TurnRecorder), and so is
/// its error. It is not the sum of the samples' errors: each reading corrects the crank and its momentum.
class TurnErrors {
 public:
  /// Begins a revolution with a blow.
  void begin(StampNs blow) noexcept;
  /// Standard deviations of a momentum [N s]: in total, and by readings alone, without an elastic rod.
  struct Momentum {
    HullWrench all, by_readings;
  };
  /// Takes the deviation of the momentum after the blow and its errors by constants [N s], which are known some time
  /// later.
  void momentumAfterBlow(const Momentum& deviation, const MomentumColumns& columns) noexcept {
    after_blow_ = deviation, at_begin_ = columns;
  }
  /// Returns true if Fz rises through zero with the coming sample; the caller calls rose() first if so.
  bool rises(double force_z) const noexcept { return last_force_ <= 0.0 && force_z > 0.0; }
  /// Begins a lobe. The momentum along z is stationary here, so that an error of the instant has no effect.
  void rose(StampNs stamp, const MomentumColumns& columns) noexcept { rise_ = {stamp, columns}; }
  /// Adds the load at a sample with its standard deviation as an extreme. rod: part of that due to an elastic rod.
  void sample(double force_z, double deviation, double common, double rod, const LoadColumns& columns) noexcept;
  /// Ends the revolution with a blow. before_blow, at_end: errors of the momentum there due to samples and to constants
  /// [N s]. weight: errors of the links' weight due to constants [N].
  PulseErrors end(StampNs blow, const HalfSinePulse& pulse, const Momentum& before_blow, const MomentumColumns& at_end,
                  const MomentumColumns& weight) const noexcept;
  /// Adds the uncertainty of a vibration's peak between samples, which only the model determines: its excess over the
  /// highest sample.
  void addPeakBetween(double peak, NumberError& error) const noexcept {
    const double beyond = std::max(0.0, peak - peak_);
    error.own = std::hypot(error.own, beyond), error.rod = std::hypot(error.rod, beyond);
  }

 private:
  struct Lobe {
    StampNs begin{};
    MomentumColumns columns{MomentumColumns::Zero()};
  };

  StampNs begin_{};
  MomentumColumns at_begin_{MomentumColumns::Zero()};
  Momentum after_blow_;
  std::optional<Lobe> rise_, lobe_;  ///< lobe begun by the last rise, and the last lobe that is large enough
  double last_force_{1.0}, peak_{};  ///< last and largest Fz [N]
  NumberError at_peak_;
  NumberError highest_;  ///< own, rod: of the sample that is highest with its own deviation added
  double reach_{};       ///< Fz of that sample plus its deviation [N]
};

/// Measures a blow. Samples after it determine its factor. It is estimated once the crank has turned by a further
/// radian, or earlier if the crank stops, restarts or strikes again.
class PendingBlow {
 public:
  /// Begins with a passage. time: of the blow [s]; speed: of the crank at the dead centre [rad/s]; rate: acceleration
  /// over speed there [1/s]; doubt: uncertainty of the crank there.
  void begin(double time, const CrankPosition& at, double speed, double rate,
             const CrankUncertainty& uncertainty) noexcept {
    waiting_ = true;
    time_ = time;
    position_ = at;
    blow_ = {};
    hull_speed_.reset();
    early_ = false;
    published_ = withheld_ = 0;
    blow_.speed = speed;
    blow_.speed_std = std::sqrt(uncertainty.own(CrankUncertainty::kSpeed, CrankUncertainty::kSpeed));
    columns_.row(0) = uncertainty.speedAtAngle(rate).cast<double>();
  }
  bool isWaiting() const noexcept { return waiting_; }
  bool isEarly() const noexcept { return early_; }  ///< the tool was met before the dead centre
  /// Discards the passage, which was no blow.
  void drop() noexcept { waiting_ = false; }
  /// Takes the estimate at the latest sample; call after begin() and then at each sample that continues.
  void follow(const BlowFactor& factor) noexcept {
    blow_.factor = factor.mean;
    blow_.factor_std = factor.deviation;
    blow_.drive_inertia = factor.drive_inertia;
    blow_.inertia_std = factor.inertia_std;
    early_ = factor.early;
    columns_.bottomRows<2>() = factor.by_constant.cast<double>();
  }
  /// Returns errors of take() due to independent errors of constants: speed [rad/s], factor [-], inertia (relative).
  BlowColumns columns() const noexcept {
    BlowColumns columns = columns_;
    if (early_) columns.row(0) = (columns_.row(0) - (blow_.speed / blow_.factor) * columns_.row(1)) / blow_.factor;
    return columns;
  }
  /// Returns the errors of crankSpeedAfter() due to constants [rad/s].
  ConstantErrors::Row columnsAfter() const noexcept {
    if (early_) return columns_.row(0).cast<float>();
    return (blow_.factor * columns_.row(0) + blow_.speed * columns_.row(1)).cast<float>();
  }
  /// Counts a sample after the blow as published or withheld. If most are withheld, as with angles in degrees, the blow
  /// is not confirmed.
  void count(bool published) noexcept { ++(published ? published_ : withheld_); }
  bool isWithheld() const noexcept { return withheld_ > published_; }
  /// Returns true if the crank has turned far enough or the time is over.
  bool isMeasured(double time, const CrankPosition& now) const noexcept {
    return waiting_ && (difference(now, position_) > kFarEnough || time - time_ > look_back::kTurn);
  }
  /// Sets the hull's velocity along z at the striking point at the blow [m/s]; not called if it is not measured.
  void setHullSpeed(double speed) noexcept { hull_speed_ = speed; }
  const std::optional<double>& hullSpeed() const noexcept { return hull_speed_; }
  double time() const noexcept { return time_; }  ///< time of the blow [s]
  double crankSpeedAfter() const noexcept { return (early_ ? 1.0 : blow_.factor) * blow_.speed; }  ///< [rad/s]
  CrankBlow take() noexcept {
    waiting_ = false;
    if (!early_) return blow_;
    CrankBlow blow = blow_;
    blow.speed /= blow.factor;
    blow.speed_std = std::hypot(blow_.speed_std, blow.speed * blow.factor_std) / blow.factor;
    return blow;
  }

 private:
  static constexpr double kFarEnough = 1.0;  // [rad]: some 50 ms
  bool waiting_{};
  double time_{};
  CrankPosition position_;
  CrankBlow blow_;
  BlowColumns columns_{BlowColumns::Zero()};
  std::optional<double> hull_speed_;
  int published_{}, withheld_{};
  bool early_{};  ///< the tool was met before the dead centre
};

class TurnFollower {
 public:
  /// Refers to its arguments, which must outlive it. prior: of the hull's motion; null: the hull is held.
  TurnFollower(const HullModel& model, const WrenchColumns& columns, const CrankStep& step, const CrankFilter& tracker,
               const RodRing& rod, const ElasticFollower& elastic, const UnmeasuredHull* prior)
      : model_(&model),
        columns_(&columns),
        step_(&step),
        tracker_(&tracker),
        rod_(&rod),
        elastic_(&elastic),
        prior_(prior) {}

  /// Sets the origin of time.
  void begin(StampNs stamp) noexcept { epoch_ = stamp; }
  /// Begins an incomplete revolution, as earlier samples do not belong to it.
  void restart() noexcept;
  /// Discards the present revolution and the blow that is being measured.
  void discard() noexcept;
  /// Ends the measurement of the pending blow, which becomes one of the `ends`.
  void finishBlow(SampleResult& result) noexcept;
  /// Follows the step up to the sample of `result`. Revolutions whose blow is measured by now are its `ends`, some 50
  /// ms after the blow, with its stamp. hull: motion over the step.
  void follow(const HullMotion& hull, SampleResult& result) noexcept;

  /// Notes that the last sample's loads were withheld.
  void withheld() noexcept {
    run_up_ = false;
    peak_.withheld = std::max(peak_.withheld, std::exchange(peak_.of_step, 0.0));
    if (pending_.isWaiting()) pending_.count(false);
  }
  /// Takes a published result.
  void published(const SampleResult& result) noexcept {
    run_up_ = true;
    peak_.published = std::max(peak_.published, std::exchange(peak_.of_step, 0.0));
    if (pending_.isWaiting()) pending_.count(true);
    trackErrors(result);
  }
  bool blowWaits() const noexcept { return pending_.isWaiting(); }  ///< a blow is still being measured
  /// Sets the velocity of the hull at that blow; without it, the prior of the hull's motion is used.
  void hullMovedAtBlow(const TipVelocity& hull) noexcept;

  double peakForce() const noexcept {
    return peak_force_;
  }  ///< peak force of the last whole revolution's strike [N], 0 before it
  std::uint64_t blows() const noexcept { return turns_ - impossible_; }   ///< number since the start
  std::uint64_t impossibleBlows() const noexcept { return impossible_; }  ///< RockerBlow::impossible, not in blows()
  std::uint64_t blankFirings() const noexcept { return blank_; }  ///< passages onto the mirrored branch, without a tool
  std::uint64_t backwardPasses() const noexcept {
    return backward_;
  }  ///< number of backward passages of the blow, minus those forward again

 private:
  void inflateImpossible(CrankBlow crank, bool early, TurnEnd& end) const noexcept;
  void addLaterMomentum(const CrankBlow& crank, LinkMomentum& after, RockerBlow& blow) const noexcept;
  void addHullDeviation(const HullMotionCovariance& hull, CrankBlow& crank) const noexcept;
  void countHullSpeed(TurnEnd& end) const noexcept;
  void countBackward(const CrankStep::Passage& passage) noexcept;
  double partOfStep(bool rings) const noexcept;
  void recordTo(double from, double to) noexcept;
  void endTurn(const CrankStep::Passage& passage) noexcept;
  void endPulse(const TurnInstant& at, const CrankEstimate& before, const CrankUncertainty& uncertainty,
                const Eigen::Matrix3d& by_readings, TurnEnd& end) noexcept;
  void trackErrors(const SampleResult& result) noexcept;
  TurnInstant instant(double time, const CrankEstimate& crank) const noexcept;
  TurnInstant ringing(double origin, double time) const noexcept;

  const HullModel* model_;
  const WrenchColumns* columns_;
  const CrankStep* step_;
  const CrankFilter* tracker_;
  const RodRing* rod_;
  const ElasticFollower* elastic_;
  const UnmeasuredHull* prior_;
  TurnRecorder turn_;
  TurnErrors errors_;
  PendingBlow pending_;
  TurnEnd pending_end_;  ///< end of the revolution with the pending blow
  HullMotion hull_;
  StampNs epoch_{};                   ///< first sample since the last restart by time
  std::optional<StampNs> last_blow_;  ///< stamp of the last blow, if the revolution since then is complete
  std::uint64_t turns_{}, impossible_{}, backward_{}, blank_{};
  double peak_force_{};
  bool run_up_{};  ///< the last sample's loads are published
  /// Peak of Fz over the present revolution [N]: of steps to a published sample, to a withheld one, and of the last
  /// step.
  struct Peak {
    double published{}, withheld{}, of_step{};
    double of_strike{}, of_ring{};  ///< peak at points without and with vibration of the rod
  };
  Peak peak_;
};

}  // namespace hammer_loads
