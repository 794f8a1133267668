/// Counter of the load cycles of all channels and hot spots of a machine, sample by sample.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/life/cycle_counter.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/life/turn_loads.h"

namespace hammer_loads::life {

/// Piece of a period: for each channel the cycles closed since the last piece, and the residue since the count began.
struct LifePiece {
  std::int64_t stamp{};             ///< stamp of the last sample [ns]; 0 for a first piece without one
  std::uint64_t duration{};         ///< time between its samples, gaps left out [ns]
  std::uint64_t turns{};            ///< blows
  std::uint64_t messages{};         ///< messages of the crank, refused ones included
  std::vector<std::int64_t> marks;  ///< marks of some of them, by which a part of a recording is recognised
  std::vector<CycleCount> counts;   ///< in the order of channels()

  /// Extends the piece by a later one of the same run.
  void advance(const LifePiece& since);
};

/// Counter of load cycles. The loop of the caller:
///
///     if (recorder.due(stamp)) use(recorder.take());   // before the sample: pieces end at whole periods and days
///     recorder.between(instant, values, deviations, common);  // each extreme since the last sample, in time order
///     recorder.sample(stamp, values, deviations, common);
///
/// recorder.gap() where samples are missing or time ran back, recorder.turn() at each blow, take() at the end.
class LifeRecorder {
 public:
  /// `inputs`: names of the values that sample() will get. Throws std::invalid_argument for a channel that is not among
  /// them.
  LifeRecorder(const LifeSettings& settings, const std::vector<std::string>& inputs);

  /// Values of the inputs at an instant [ns], in their order, their standard deviations and the part of these that
  /// constants make; NaN: none, and the last two may be null. No allocation.
  void sample(std::int64_t stamp, const double* values, const double* deviations,
              const double* common = nullptr) noexcept;
  /// Values at an instant between two samples [ns], where some are known; NaN: not known there, which is no sample left
  /// out. A hot spot counts where all its loads are known. Deviations: of a sample beside it. No allocation.
  void between(std::int64_t instant, const double* values, const double* deviations = nullptr,
               const double* common = nullptr) noexcept;
  /// Samples are missing before the next one, or time runs back there.
  void gap() noexcept;
  void turn() noexcept;

  /// Returns true if a piece ends before a sample of this stamp: a period or a day (UTC) is over, or time ran back.
  /// Pieces of at most one period and one day make the trend by day equal live and from bags.
  bool due(std::int64_t stamp) const noexcept;
  /// Ends the piece. Allocates, and takes some ms for many cycles: not for the hot path.
  LifePiece take();

  /// Names under which the channels are counted, and their grids.
  const std::vector<std::string>& channels() const { return names_; }
  const LoadGrid& grid(std::size_t channel) const { return counted_[channel].counter.grid(); }
  /// Since the last take().
  const SampleTally& tally(std::size_t channel) const { return counted_[channel].counter.tally(); }

 private:
  struct Term {
    std::size_t input{};
    double factor{};
  };
  struct Counted {
    double valueOf(const double* values) const noexcept;
    LoadError errorOf(const double* deviations, const double* common) const noexcept;

    CycleCounter counter;
    std::vector<Term> terms;  ///< terms of the counted sum; one of factor 1 for a load
    TurnExtremes extremes{};  ///< extremes of the present revolution
  };

  void lastUntil(std::int64_t stamp) noexcept;

  std::vector<std::string> names_;
  std::vector<Counted> counted_;
  std::int64_t period_{};
  std::int64_t piece_start_{}, last_{};  ///< stamps [ns]
  bool piece_begun_{}, contiguous_{};
  std::uint64_t duration_{}, turns_{};
};

/// Days since 1970-01-01 UTC.
std::int64_t dayOf(std::int64_t stamp) noexcept;

}  // namespace hammer_loads::life
