/// Instants of crank samples whose stamps are rounded, repeat, come in bursts or out of order. Recognition of a
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
  static constexpr std::int64_t kCommon = 240000000;                ///< common multiple of all periods [ns]
  using Turns = std::array<std::complex<double>, kPeriods.size()>;  ///< exp(2 pi i instant/period) of each
  static constexpr double kRecognised = 0.5;                        ///< by chance once in exp(100)
  static constexpr double kDivides = 0.1;  ///< share of a period up to which an interval counts as whole periods
  static constexpr double kMost = 0.5;     ///< share of the mean interval by which one may differ
  static constexpr double kLongest = 0.1;  ///< [s]
  static constexpr double kOften = 0.2, kStuck = 0.98;

  RunningMean<> step_{look_back::kReadings}, repeats_{look_back::kReadings};
  Turns taken_{};        ///< means of exp(2 pi i instant/period)
  double readings_{};    ///< number of readings in the means
  double grid_{};        ///< period of the grid [s]; 0: none
  std::int64_t last_{};  ///< stamp [ns]
};

/// Sampling of a sensor with equal intervals, as known before a sample.
struct SampleClock {
  double interval{};        ///< [s]; 0 if not known or not constant
  double suspected_loss{};  ///< lateness of the sample's stamp in whole intervals [s], perhaps without a loss
  bool may_have_lost{};     ///< the stamp allows for lost samples before it
};

/// Estimate of a sensor's own clock from the stamps of its samples: a line by sequence number. Its offset and interval
/// are found by least squares over all samples so far, later over the last 4000 (expanding, then fading memory). Delays
/// that do not depend on the sequence average out; a constant one is not observable. Only the last of several samples
/// with one stamp is used, as it waited least. Lost samples are counted by whole intervals: a likelihood test between
/// none and one lost, as fast as the stamps' scatter allows.
class SteadyClockFit {
 public:
  void begin(std::int64_t stamp) noexcept;
  /// Adds the next sample's stamp [ns]; returns its instant on the line so far [ns].
  std::int64_t add(std::int64_t stamp) noexcept;
  /// Notes lost samples before the last one: it and the following ones are later by this number of intervals.
  void skip(double intervals) noexcept;
  /// Returns true if the last stamp excludes a loss before it.
  bool contradictsLoss() const noexcept;
  /// Sets whether the readings exclude a loss before the last sample. While they do, stamps that wander by whole
  /// intervals do not move the line.
  void confirm(bool counted) noexcept;
  /// Number of lost samples that would explain the lateness of the last stamp; a stamp that is merely late looks alike.
  double suspected() const noexcept { return suspected_; }
  /// Returns true if the last stamp showed that too many samples were counted before it.
  bool movedBack() const noexcept { return moved_back_; }
  double interval() const noexcept { return interval_; }  ///< [ns]
  /// Lateness of the last stamp if it exceeds the scatter [ns]; else 0.
  double lateness() const noexcept;
  /// Root mean square of the stamps about the line [ns].
  double scatter() const noexcept { return std::sqrt(end_square_); }
  /// Root mean square error of a stamp that is used without refitting: the scatter and, if stamps repeat, the wait for
  /// the last sample [ns].
  double stampError() const noexcept { return std::hypot(scatter(), (mean_length_ - 1.0) * interval_); }
  int runs() const noexcept { return runs_; }  ///< stamps after the first one
  bool isKnown() const noexcept;               ///< enough stamps for a line and the samples per stamp
  bool inBursts() const noexcept;              ///< several samples come with each stamp
  /// Returns true if equal intervals explain the stamps: their scatter about the line does not grow beyond that of
  /// their steps, or is small beside the time from burst to burst.
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
  double instant_{};       ///< instant of the last sample on the line [ns]
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
  bool is_late_{};  ///< the last stamp is later than the scatter explains
  int runs_{};
  int begun_{};  ///< number of resets of the line for a loss
};

/// Detection of stamps that a clock rounds to whole steps, down, up or to the nearest. All samples then have a common
/// error of up to half a step, which the stamps do not show. Evenly spaced stamps may be exact; rounded ones are uneven
/// by whole steps.
class StampRounding {
 public:
  /// Adds the difference between successive stamps [ns].
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
  static constexpr std::int64_t kTolerance = 1000;  // [ns]: rounding of stamps transmitted in seconds
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
  kHeader,  ///< header stamps; a stamp out of order is refused
  kSteady,  ///< taken at equal intervals: header stamps refitted by the sequence of arrival
};

/// Assigns instants to samples in their order of arrival. A sample keeps its header stamp, bit for bit, if the last
/// thousand contain no irregular one, however uneven the intervals. If a few stamps repeat or go back a little, the
/// sample gets an instant between its neighbours. If many do and the sensor samples at equal intervals, all samples get
/// instants on the line through the stamps so far. Until the line is known, after six bursts, only the first sample of
/// each counts. A burst at rest without speeds looks like duplicates: the first moving burst restarts the line. No
/// later samples are used; instants strictly increase until a restart.
class StampSequence {
 public:
  enum class Kind {
    kPlaced,      ///< the instant is valid
    kDuplicate,   ///< repeated message without effect, at rest perhaps part of a burst; or another message with the
                  ///< same stamp, whose instant is not known yet
    kOutOfOrder,  ///< kHeader: not after the last; else: far back, and the next one shows whether time went back
    kRestart,     ///< placed, without continuing the past: a gap, or time went back
  };
  struct Place {
    Kind kind{Kind::kPlaced};
    std::int64_t stamp{};  ///< instant [ns]
  };

  /// stale_after: gap, or step back in time, beyond which a sample restarts the sequence [s].
  StampSequence(CrankStamps mode, double stale_after) noexcept;

  /// Comparison of a message's values with those of the message before.
  enum class Repeats {
    kNo,
    kAtRest,       ///< equal, as for a crank at rest
    kWithinCount,  ///< equal, as for a crank that turns by less than a count
    kAtWork,       ///< equal although the crank turns: a measured speed or a moving angle cannot repeat
  };
  /// Places the next message. header: its stamp [ns].
  Place place(std::int64_t header, Repeats repeats) noexcept;
  /// Notes that samples were lost before the last one, as the readings show: it and the coming ones are later by `time`
  /// [s], whole intervals. Returns its instant [ns].
  std::int64_t skip(double time) noexcept;
  SampleClock clock() const noexcept {
    if (!steady_ || !fit_.isKnown()) return {};
    const double interval = 1e-9 * fit_.interval();
    return {interval, interval * fit_.suspected(), !fit_.contradictsLoss()};
  }
  /// Lateness of a header stamp that is used as it is [s]; else 0.
  double lateness() const noexcept { return steady_ ? 0.0 : 1e-9 * fit_.lateness(); }
  /// Counts the last stamp as two irregular ones: the readings show that it is late and its sample is not.
  void countLate() noexcept { irregularity_ += 2.0; }
  /// See SteadyClockFit.
  void confirm(bool counted) noexcept { fit_.confirm(counted); }
  /// Step to which the header stamps are rounded [s]; 0: none.
  double rounding() const noexcept { return rounding_.step(); }
  /// Returns true if the last sample's instant on the line was not after the one before, and was set just after it.
  bool isCrowded() const noexcept { return is_crowded_; }
  /// Error of the stamps if they were refitted before the last restart [s], else 0. They are used unchanged until there
  /// is a line again.
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
  double irregularity_{};                ///< recent irregular stamps
  std::uint64_t irregular_{};
  bool doubled_{};    ///< messages are sent twice
  bool uncounted_{};  ///< messages were taken for duplicates since the fit began
  bool steady_{};
  bool is_crowded_{};
  bool awaits_line_{};             ///< stamps came in bursts before the restart: none has an instant without a line
  double error_before_restart_{};  ///< [s]
  SteadyClockFit fit_;
  StampRounding rounding_;
};

}  // namespace hammer_loads
