/// Instants of crank samples whose stamps are rounded, repeat, come in bursts or change places, and recognition of a
/// controller that reads the encoder in a task of its own and sends the reading later.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/estimation/running_mean.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {

/// Readings that a controller takes in a task of period T and sends at another rate are as old as its last task. The
/// instants at which they were taken are the stamps corrected by the innovations over the speed. They lie on a grid of
/// T, on which the stamps do not lie; jitter has no grid. The statistic is that of Rayleigh's test, the length of the
/// mean of exp(2 pi i instant/T) over some 200 samples: 1 on the grid, some 0.06 elsewhere. Stamps at equal intervals
/// lie on each grid that divides the interval. A task of such a period is therefore not recognised: the age of its
/// readings is constant.
class ControllerTask {
 public:
  /// Adds a reading with its stamp [ns]. off: innovation of its angle over the speed [s]; 0 at low speed.
  void add(std::int64_t stamp, double off) noexcept {
    repeats_.add(0.0);
    if (addStep(stamp) && off != 0.0) findGrid(stamp, off);
  }
  /// Adds a repetition of the last reading with this stamp [ns], although the crank has turned.
  void repeat(std::int64_t stamp) noexcept {
    repeats_.add(1.0);
    addStep(stamp);
  }

  /// Period of the task that is recognised [s]; 0: none.
  double period() const noexcept {
    const bool often = repeats_.isFull() && repeats_.mean() > kOften && repeats_.mean() < kStuck;
    return often ? step_.mean() / (1.0 - repeats_.mean()) : grid_;
  }

 private:
  /// Adds an interval to their mean, in which jitter cancels. Returns false after a gap.
  bool addStep(std::int64_t stamp) noexcept {
    const double step = 1e-9 * static_cast<double>(stamp - std::exchange(last_, stamp));
    if (!(std::abs(step) < kLongest)) return false;
    const double mean = step_.mean(), most = kMost * mean;
    step_.add(step_.count() > 0.0 ? mean + std::clamp(step - mean, -most, most) : step);
    return true;
  }
  void findGrid(std::int64_t stamp, double off) noexcept {
    double length = square(kRecognised);
    grid_ = 0.0;
    readings_ = std::min(readings_ + 1.0, look_back::kReadings);
    const double turns = (1e-9 * static_cast<double>(stamp % kCommon) + off) / (1e-9 * kCommon);
    const std::complex<double> z = std::polar(1.0, kTwoPi * turns), z3 = z * z * z, z4 = z * z3, z12 = z4 * z4 * z4,
                               z15 = z12 * z3, z16 = z12 * z4, z20 = z16 * z4, z24 = z12 * z12, z30 = z15 * z15,
                               z40 = z20 * z20, z60 = z30 * z30;
    const Turns of_periods{z60 * z60, z40 * z40, z60, z24 * z24, z40, z30, z24, z20, z16, z15, z12};
    for (std::size_t i = 0; i < kPeriods.size(); ++i) {
      taken_[i] += (of_periods[i] - taken_[i]) / readings_;
      if (!(std::norm(taken_[i]) > length) || readings_ < look_back::kReadings) continue;
      const double period = 1e-3 * static_cast<double>(kPeriods[i]);
      if (std::abs(std::remainder(step_.mean() / period, 1.0)) < kDivides) continue;
      length = std::norm(taken_[i]);
      grid_ = period;
    }
  }

  // Numerical: kCommon, kTolerance
  static constexpr std::array<int, 11> kPeriods{2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20};  ///< [ms]
  static constexpr std::int64_t kCommon = 240000000;  ///< multiple of all periods [ns]: its turns' powers are theirs
  using Turns = std::array<std::complex<double>, kPeriods.size()>;  ///< exp(2 pi i instant/period) of each
  static constexpr double kRecognised = 0.5;                        ///< by chance once in exp(100)
  static constexpr double kDivides = 0.1;  ///< share of a period up to which an interval counts as whole periods
  static constexpr double kMost = 0.5;     ///< share of the mean interval by which one may differ from it
  static constexpr double kLongest = 0.1;  ///< [s]
  static constexpr double kOften = 0.2, kStuck = 0.98;

  RunningMean<> step_{look_back::kReadings}, repeats_{look_back::kReadings};
  Turns taken_{};        ///< means of exp(2 pi i instant/period)
  double readings_{};    ///< in it
  double grid_{};        ///< period of the grid [s]; 0: none
  std::int64_t last_{};  ///< stamp [ns]
};

/// Knowledge of the time before a sample that is one of equal intervals.
struct SampleClock {
  double interval{};        ///< [s]; 0 if not known or not constant
  double suspected_loss{};  ///< time by which the sample's stamp is late, in whole intervals [s]; it may only be late
  bool may_have_lost{};     ///< the stamp allows for lost samples before it
};

/// Estimate of a sensor's own clock from the stamps of its samples: a line by sequence number, whose offset and
/// interval are found by least squares over all samples so far, later over the last 4000 (expanding, then fading
/// memory). Delays that do not depend on the sequence average out; a constant one is not observable. The last of
/// several samples with one stamp is used, as it waited least. Lost samples are counted by whole intervals: a test of
/// likelihood between none and one lost, as fast as the stamps' scatter allows.
class SteadyClockFit {
 public:
  void begin(std::int64_t stamp) noexcept;
  /// Takes the next sample's stamp [ns]; returns its instant on the line so far [ns].
  std::int64_t add(std::int64_t stamp) noexcept;
  /// Notes lost samples before the last one: it and the following ones are later by this number of intervals.
  void skip(double intervals) noexcept;
  /// Returns true if the last stamp agrees with no loss before it and would show a loss.
  bool contradictsLoss() const noexcept;
  /// Takes whether the readings show that none was lost before the last sample. While they do, stamps that wander by
  /// whole intervals do not move the line.
  void confirm(bool counted) noexcept;
  /// Number of lost samples that would explain the lateness of the last stamp; a stamp that is merely late looks alike.
  double suspected() const noexcept { return suspected_; }
  /// Returns true if the last stamp showed that samples before it were counted too many.
  bool movedBack() const noexcept { return moved_back_; }
  double interval() const noexcept { return interval_; }  ///< [ns]
  /// Time by which the last stamp is later than the scatter makes it [ns]; else 0.
  double lateness() const noexcept;
  /// Root mean square of the stamps about the line [ns].
  double scatter() const noexcept { return std::sqrt(end_square_); }
  /// Root mean square by which a stamp errs that is taken as it is: the scatter, and where some stamps repeat the wait
  /// for the last sample [ns].
  double stampError() const noexcept { return std::hypot(scatter(), (mean_length_ - 1.0) * interval_); }
  int runs() const noexcept { return runs_; }  ///< stamps after the first one
  bool isKnown() const noexcept;               ///< stamps enough for a line and for how many samples have one stamp
  bool inBursts() const noexcept;              ///< several samples come with each stamp
  /// Equal intervals explain the stamps: their scatter about the line does not grow beyond that of their steps, or is
  /// small beside the time from burst to burst.
  bool explains() const noexcept;

 private:
  double scatterGain() const noexcept;
  double mostUsed() const noexcept;
  void endRun() noexcept;
  void move(double by) noexcept;
  bool lostWhileUnknown(double residual) const noexcept;
  void watchLost(double residual, double step) noexcept;

  std::int64_t origin_{};  ///< first stamp [ns]; all else relative to it, so that no digits are lost
  std::int64_t stamp_{};   ///< last [ns]
  double instant_{};       ///< on the line, of the last sample [ns]
  double interval_{};      ///< [ns]
  double residual_{};      ///< stamp less instant, of the last sample [ns]
  double end_residual_{};  ///< residual of the last sample of the run before [ns]
  int run_length_{};       ///< samples with the last stamp
  int longest_{};          ///< samples in the longest run
  double mean_length_{1.0};
  double end_square_{}, step_square_{};     ///< mean squares of the runs' end residuals and of their steps [ns2]
  double end_mean_{};                       ///< mean of the runs' end residuals [ns]
  double start_mean_{}, start_variance_{};  ///< mean [ns] and variance [ns2] of the runs' first residuals
  /// Evidence that the line is off by whole intervals, from the stamp on that began to show it.
  struct Evidence {
    double logarithm{};  ///< logarithm of the likelihood ratio
    double mean{};       ///< mean lateness of the stamps [ns]
    int stamps{};

    void add(double by, double late) noexcept {
      logarithm += by;
      mean += (late - mean) / ++stamps;
      if (!(logarithm > 0.0)) *this = {};
    }
  };
  double independence() const noexcept;
  void gatherEvidence(double off, double scatter, double step) noexcept;
  double correctCount() noexcept;
  Evidence lost_, gained_;
  double suspected_{};      ///< lost samples by which the last stamp alone is late
  double remembered_{1.0};  ///< runs in the line's memory
  int unsure_stamps_{};     ///< number of stamps that may still show a miscount which no reading has excluded
  bool moved_back_{};
  bool is_late_{};  ///< the last stamp is later than scatter makes it
  int runs_{};
  int begun_{};  ///< number of resets of the line for a loss
};

/// A clock that is read in whole steps rounds down, up or to the nearest: the stamps do not say which, and all samples
/// are off alike by up to half a step from their middle. Stamps at even steps may be exact; those that are rounded are
/// uneven by whole steps.
class StampRounding {
 public:
  /// From one stamp to the next [ns].
  void add(std::int64_t difference) noexcept {
    while (step_ < kSteps.size() && !isWhole(difference, kSteps[step_])) ++step_, stamps_ = uneven_ = 0;
    if (step_ == kSteps.size()) return;
    if (stamps_ > 0) uneven_ += std::llabs(difference - last_) > kTolerance;
    last_ = difference;
    if (++stamps_ < kMany) return;
    rounded_ = uneven_ > kUneven;
    stamps_ = 1, uneven_ = 0;
  }
  double step() const noexcept {
    return rounded_ && step_ < kSteps.size() ? 1e-9 * static_cast<double>(kSteps[step_]) : 0.0;
  }  ///< [s]

 private:
  static constexpr std::array<std::int64_t, 6> kSteps{10000000, 5000000, 2000000, 1000000, 500000, 100000};  ///< [ns]
  static constexpr std::int64_t kTolerance = 1000;  // [ns]: of stamps that were numbers of seconds on their way
  static constexpr int kMany = 100;                 // stamps that are judged together
  static constexpr int kUneven = 10;                // of them: some samples are late or lost

  static bool isWhole(std::int64_t difference, std::int64_t step) noexcept {
    const std::int64_t rest = std::llabs(difference) % step;
    return rest <= kTolerance || step - rest <= kTolerance;
  }

  std::size_t step_{};  ///< index in kSteps of the largest one that divides all stamps
  std::int64_t last_{};
  int stamps_{}, uneven_{};
  bool rounded_{};
};

/// Instants that the samples get.
enum class CrankStamps {
  kAuto,    ///< header stamps as they are, unless they repeat or change places
  kHeader,  ///< header stamps; what does not follow them is refused
  kSteady,  ///< taken at equal intervals: header stamps refitted by the sequence of arrival
};

/// The sequence of samples is their order of arrival. A sample without irregular ones among the last thousand keeps its
/// header stamp, bit for bit, however irregular the intervals. Where a few stamps repeat or run back a little, the
/// sample gets an instant between its neighbours; where many do and the sensor evidently samples at equal intervals,
/// all get the line through the stamps so far. Only the first sample of each burst counts until the line is known, six
/// bursts on. A burst at rest without speeds looks like duplicates: the line begins anew with the first burst that
/// moves. It uses no later samples; instants strictly increase until a restart.
class StampSequence {
 public:
  enum class Kind {
    kPlaced,      ///< the instant holds
    kDuplicate,   ///< repetition of the message, which changes nothing; of a crank at rest it may be one of a burst. Or
                  ///< another one with the same stamp, whose instant is not known yet
    kOutOfOrder,  ///< with kHeader: not after the last; else: so far back that the next one shows whether time ran back
    kRestart,     ///< placed, but nothing before it continues: a gap, or time ran back
  };
  struct Place {
    Kind kind{Kind::kPlaced};
    std::int64_t stamp{};  ///< instant [ns]
  };

  /// stale_after: gap or way back from which on a sample starts anew [s].
  StampSequence(CrankStamps mode, double stale_after) noexcept;

  /// Comparison of a message's values with those of the message before.
  enum class Repeats {
    kNo,
    kAtRest,       ///< equal, as of a crank that rests
    kWithinCount,  ///< equal, as of a crank that turns by less than a count meanwhile
    kAtWork,       ///< equal though the crank turns: a measured speed, or an angle that moves on, cannot repeat
  };
  /// header: stamp of the message that arrives [ns].
  Place place(std::int64_t header, Repeats repeats) noexcept;
  /// The readings show that samples were lost before the last one: it and the coming ones are so much later [s], whole
  /// intervals. Its instant [ns].
  std::int64_t skip(double time) noexcept;
  SampleClock clock() const noexcept {
    if (!steady_ || !fit_.isKnown()) return {};
    const double interval = 1e-9 * fit_.interval();
    return {interval, interval * fit_.suspected(), !fit_.contradictsLoss()};
  }
  /// Time by which a header stamp that counts is later than others are [s]; else 0.
  double lateness() const noexcept { return steady_ ? 0.0 : 1e-9 * fit_.lateness(); }
  /// The readings show that the last stamp is late and its sample is not: it counts as two irregular ones.
  void countLate() noexcept { irregularity_ += 2.0; }
  /// See SteadyClockFit.
  void confirm(bool counted) noexcept { fit_.confirm(counted); }
  /// Step of which header stamps are whole multiples though the samples are not taken so [s]; 0: none.
  double rounding() const noexcept { return rounding_.step(); }
  /// Returns true if the last sample's instant on the line was not after the one before, and was set just after it.
  bool isCrowded() const noexcept { return is_crowded_; }
  /// Error of the stamps that were refitted before the last restart [s]; 0: none was. They are taken as they are until
  /// there is a line again.
  double errorBeforeRestart() const noexcept { return error_before_restart_; }
  /// Returns true while stamps are refitted by sequence.
  bool isSteady() const noexcept { return steady_; }
  /// Number of stamps that repeated or changed places since the start.
  std::uint64_t irregular() const noexcept { return irregular_; }
  const SteadyClockFit& fit() const noexcept { return fit_; }

 private:
  Place begin(std::int64_t header) noexcept;
  Place next(std::int64_t header) noexcept;

  CrankStamps mode_;
  std::int64_t stale_;                   ///< [ns]
  std::optional<std::int64_t> header_;   ///< header stamp of the last accepted message [ns]
  std::optional<std::int64_t> rewound_;  ///< header stamp of the last message, if it was refused as out of order
  std::int64_t newest_{};                ///< latest header stamp since the beginning [ns]
  std::int64_t placed_{};                ///< instant of the last message [ns]
  double irregularity_{};                ///< irregular stamps of late
  std::uint64_t irregular_{};
  bool doubled_{};    ///< messages do come twice
  bool uncounted_{};  ///< messages passed for duplicates since the beginning of the fit
  bool steady_{};
  bool is_crowded_{};
  bool awaits_line_{};             ///< stamps came in bursts before the restart: none has an instant without a line
  double error_before_restart_{};  ///< [s]
  SteadyClockFit fit_;
  StampRounding rounding_;
};

}  // namespace hammer_loads
