/// A sensor's own clock, seen through the stamps that its samples got on their way.
#pragma once

#include <cmath>
#include <cstdint>

namespace hammer_loads {

/// Line through stamps by sequence number: offset and interval by least squares of all samples so far, then of the last
/// some 4000 (expanding, then fading memory). Delays that do not depend on the sequence average out; a constant one
/// cannot be seen. Of samples with one stamp the last counts: it waited least. Lost samples are counted by whole
/// intervals: a test of likelihood between none and one lost, as fast as the stamps' scatter allows.
class SteadyClockFit {
 public:
  void begin(std::int64_t stamp) noexcept;
  /// The next sample's stamp [ns]; its instant on the line so far [ns].
  std::int64_t add(std::int64_t stamp) noexcept;
  /// Samples were lost before the last one: it and the coming ones are this number of intervals later.
  void skip(double intervals) noexcept { shift(intervals); }
  /// The last stamp is where it must be without a loss before it, though one would show.
  bool contradictsLoss() const noexcept;
  double interval() const noexcept { return interval_; }  ///< [ns]
  /// Of stamps about the line, root of mean square [ns].
  double scatter() const noexcept { return std::sqrt(end_square_); }
  int runs() const noexcept { return runs_; }  ///< stamps after the first one
  bool isKnown() const noexcept;               ///< stamps enough for a line and for how many samples have one stamp
  bool inBursts() const noexcept;              ///< several samples come with each stamp
  /// Equal intervals explain the stamps: their scatter about the line does not grow beyond that of their steps, or is
  /// small beside the time from burst to burst.
  bool explains() const noexcept;

 private:
  double scatterGain() const noexcept;
  void endRun() noexcept;
  void shift(double intervals) noexcept;
  void watchLost(double residual) noexcept;

  std::int64_t origin_{};  ///< first stamp [ns]; all else relative to it, so that no digits are lost
  std::int64_t stamp_{};   ///< last [ns]
  double instant_{};       ///< on the line, of the last sample [ns]
  double interval_{};      ///< [ns]
  double residual_{};      ///< stamp less instant, of the last sample [ns]
  double end_residual_{};  ///< of the last sample of the run before [ns]
  int run_length_{};       ///< samples with the last stamp
  double mean_length_{1.0};
  double end_square_{}, step_square_{};     ///< of residuals at the runs' ends and of their steps, running means [ns2]
  double start_mean_{}, start_variance_{};  ///< of residuals at the runs' beginnings, running [ns], [ns2]
  double lost_evidence_{}, gained_evidence_{};  ///< logarithm of likelihood ratio
  int runs_{};
};

}  // namespace hammer_loads
