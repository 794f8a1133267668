/// Complete result of one crank sample.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hammer_loads/crank/crank_estimate.h"
#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/hull_state.h"
#include "hammer_loads/pipeline/number_error.h"
#include "hammer_loads/pipeline/refusal.h"
#include "hammer_loads/pipeline/unknown_force.h"

namespace hammer_loads {

/// Blow and, if the revolution before it was observed completely, its pulse. It is known some 50 ms after the blow.
struct TurnEnd {
  StampNs stamp{};       ///< instant of the blow, found between samples [ns]
  std::uint64_t turn{};  ///< blows since the start, 1 for the first
  RockerBlow blow;
  BlowErrors blow_errors;
  enum class Struck : std::uint8_t { kUnknown, kTool, kHull } struck{};
  double mean_hold_down_force{};  ///< tool impulse times blow rate [N]; NaN for an incomplete revolution
  std::optional<HalfSinePulse> pulse;
  PulseErrors pulse_errors;
};

/// One publication of the hull wrench.
struct WrenchOutput {
  StampNs stamp{};
  double interval{};          ///< the wrench is the mean over it, before the stamp [s]; 0: at the stamp
  CrankEstimate crank;        ///< at the stamp
  HullWrench wrench;          ///< wrench of links and drive
  double drive_reaction_y{};  ///< part of its moment [N m]
  HullDeviation deviation;    ///< for a mean: that at its end or, if less, the bound by the momenta at both ends; its
                              ///< common part is that of the mean
  bool near_blow{};           ///< transmission angle below near_blow_deg
};

struct SampleResult {
  /// deviation.wrench() and rod_ring where the sample stands for an extreme of the revolution. For a vibration of
  /// unknown phase that is the crest, the root of two times its root mean square.
  struct OfExtreme {
    HullWrench deviation, ring;
    UnknownForce::Squares unknown;
  };
  OfExtreme ofExtreme() const noexcept {
    const UnknownForce::Squares crest = UnknownForce::ofExtreme(unknown);
    Eigen::Vector3d all = deviation.covariance.diagonal() + (crest - unknown).rowwise().sum();
    if (rod_followed) return {wrenchOf(all.cwiseSqrt()), rod_ring, crest};
    const Eigen::Vector3d ring = vectorOf(rod_ring);
    all += ring.cwiseAbs2();
    return {wrenchOf(all.cwiseSqrt()), wrenchOf(std::sqrt(2.0) * ring), crest};
  }

  LinkState linkState() const noexcept {
    LinkState state = hammer_loads::linkState(links, crank.position.angle, crank.speed);
    state.rocker_angle += rocker_displacement, state.rocker_speed += rocker_displacement_rate;
    return state;
  }

  StampNs stamp{};                 ///< instant of the sample: its header stamp, or that refitted by sequence
  StampNs sample_stamp{};          ///< header stamp of the sample
  std::optional<Refusal> refusal;  ///< if set, all below except `ends` is void
  /// True if the side of the blow is uncertain at the sample. Values at its instant belong to the likelier side and are
  /// not published; sums over steps continue.
  bool beside_blow{};
  /// A force's standard deviation exceeds the peak at constant speed, or, where the crank is held at constant speed,
  /// five times withhold_above of its peak: the sample is not published. Sums over steps continue.
  bool uncertain{};
  bool isPublished() const noexcept { return !refusal && !beside_blow && !uncertain; }
  Level level{};  ///< level of the model that gave the wrench: linkage where `elastic` is not confirmed by the readings
  CrankEstimate crank;
  CrankUncertainty uncertainty;  ///< uncertainty of the crank's motion
  LoadColumns load_columns;      ///< errors of the wrench
  HullWrench rod_momentum;  ///< possible momentum of the rocker relative to a rigid rod's, without a followed spring
  /// Covariance of the wrench's errors other than those of the crank's motion: rod, contact and unknown forces, in
  /// products of [N], [N], [N m].
  Eigen::Matrix3d other_covariance{Eigen::Matrix3d::Zero()};
  HullWrench rod_ring;  ///< part of the deviation due to the rod's spring, which the level neglects
  UnknownForce::Squares unknown{UnknownForce::Squares::Zero()};  ///< squares of forces that no level models, by source
  bool rod_followed{};                ///< if false, rod_ring is a root mean square over an unknown phase
  HullDeviation deviation;            ///< at the sample, including the hull's motion
  double consistency{};               ///< CrankFilter::consistency()
  bool inconsistent{};                ///< readings contradict the model, but not enough to withhold samples
  LinkMotion links;                   ///< links as with a rigid rod
  double rocker_displacement{};       ///< angle of the rocker minus that with a rigid rod [rad]
  double rocker_displacement_rate{};  ///< rate of that angle [rad/s]
  HullState::Motion hull;
  bool pitch_known{};  ///< every pitch joint has been received; else the weight follows from hull_pitch_rad
  HullWrench wrench;   ///< at the sample, of links and drive
  PinReactions pins;
  const BoomState* boom{};            ///< null: no boom; with a fault only its stamp and fault are valid
  std::vector<WrenchOutput> outputs;  ///< one at the sample, or those on the grid of output_rate since the last sample;
                                      ///< close to the blow only means
  std::size_t turn_ends{};            ///< number of valid `ends`; more than one only for sparse samples
  std::array<TurnEnd, 4> ends;
};

}  // namespace hammer_loads
