/// Recorder of a turn from blow to blow, for its pulse and the pulse's deviation.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "hammer_loads/hammer/hammer_model.h"
#include "hammer_loads/hammer/pulse.h"
#include "hammer_loads/pipeline/number_error.h"
#include "hammer_loads/util/stamp.h"

namespace hammer_loads {

/// State of the mechanism at an instant of a turn, as the recorder needs it.
struct TurnInstant {
  double time{};          ///< since any fixed origin [s]
  HullWrench wrench;      ///< weight included where the published wrench includes it
  LinkMomentum momentum;  ///< relative to the hull
  double weight_x{};      ///< weight within the wrench from here to the next instant [N]
  double weight_z{};      ///< weight along z [N]
};

/// Keeps the force and the exact impulses of the present turn in a track of bounded size. A turn with too many instants
/// loses every other point, but no impulse.
class TurnRecorder {
 public:
  TurnRecorder();

  /// A turn begins just after a blow.
  void begin(const TurnInstant& after_blow) noexcept;
  /// Replaces the momentum just after the blow by its better estimate.
  void correctBegin(const LinkMomentum& after_blow) noexcept;
  /// Discards the turn's pulse, as the coming samples may not belong to it.
  void abandon() noexcept { recording_ = false; }
  bool recording() const noexcept { return recording_; }
  /// Momentum that the turn's load would have given a free hull by the blow that ended the last turn [N s, N m s]. The
  /// hull returns each turn: its momentum has no trend and no mean, so that weight and blow are not in it. For a
  /// revolution that was not seen whole it is the momentum of the links before the blow.
  const LinkMomentum& swing() const noexcept { return swing_; }
  void add(const TurnInstant& instant) noexcept;
  /// Ends the turn just before a blow; no pulse if the turn was not seen whole or never pushed the hull up.
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

/// An impulse is the difference of two momenta and the weight's in between (TurnRecorder): so is its error. The sum of
/// the samples' errors is not: at each of them readings correct the crank, and its momentum with it.
class TurnErrors {
 public:
  /// A turn begins with a blow.
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
  /// The load at a sample, its deviation as of an extreme. rod: of that what a rod makes that may give.
  void sample(double force_z, double deviation, double common, double rod, const LoadColumns& columns) noexcept;
  /// At the blow that ends the turn. before_blow, at_end: how far the momentum there may be off, by samples and by
  /// constants [N s]; weight: what constants make of the links' weight [N].
  PulseErrors end(StampNs blow, const HalfSinePulse& pulse, const Momentum& before_blow, const MomentumColumns& at_end,
                  const MomentumColumns& weight) const noexcept;
  /// Adds the uncertainty of a vibration's peak between samples, which only the model determines: its excess over the
  /// highest sample.
  void doubtBetween(double peak, NumberError& error) const noexcept {
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
  std::optional<Lobe> rise_, lobe_;  ///< lobes begun by the last rise, and the last lobe that counts
  double last_force_{1.0}, peak_{};  ///< Fz of the last sample; its largest [N]
  NumberError at_peak_;
  NumberError highest_;  ///< own, rod: of the sample that may be highest, by one of its own deviations
  double reach_{};       ///< there [N]
};

}  // namespace hammer_loads
