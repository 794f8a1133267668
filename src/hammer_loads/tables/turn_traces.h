/// Samples of the turn with the largest peak and of a typical one.
#pragma once

#include <boost/circular_buffer.hpp>
#include <cstdint>
#include <optional>
#include <vector>

namespace hammer_loads {

struct TraceSample {
  std::int64_t stamp{};  ///< [ns]
  double force_x{}, force_z{}, torque_y{};
  double force_z_std{};
  double crank_angle{};
};

struct TurnTrace {
  std::uint64_t turn{};
  std::int64_t start{};  ///< blow that begins the turn [ns]
  double amplitude{};    ///< [N]
  std::vector<TraceSample> samples;
};

/// Memory does not grow with the run: of a turn with more than 4096 samples none is kept; the typical turn is one of at
/// most 32 that lie evenly in the run.
class TurnTraces {
 public:
  void add(const TraceSample& sample) { latest_.push_back(sample); }
  /// A turn seen whole, after its last sample; further samples may have come.
  void turnEnded(std::uint64_t turn, std::int64_t stamp, double period_s, double amplitude);

  /// The turn of the largest amplitude, the first of several; nothing before a whole turn.
  const std::optional<TurnTrace>& worst() const { return worst_; }
  /// Trace with the median amplitude of the kept ones; null before a whole revolution.
  const TurnTrace* typical() const;

 private:
  TurnTrace traceOf(std::uint64_t turn, std::int64_t stamp, double period_s, double amplitude) const;
  void keepCandidate(TurnTrace trace);

  boost::circular_buffer<TraceSample> latest_{8192};  ///< samples of a revolution and of the measurement of its blow
  std::optional<TurnTrace> worst_;
  std::vector<TurnTrace> candidates_;
  std::uint64_t turns_{}, every_{1};  ///< each every_-th turn is a candidate
};

}  // namespace hammer_loads
