/// Calibration of the crank's sensor and of the drive's inertia, from a recording at work.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/calibration/joint_fit.h"
#include "hammer_loads/crank/crank_filter.h"

namespace hammer_loads::calibration {

/// Given parameters.
struct CalibrationBasis {
  const Mechanism& mechanism;
  Level level;
  CrankFilterSettings filter;  ///< settings of the filter by the parameters in force
  double ratio{1.0};           ///< encoder turns per crank turn [-]
  // Prior: rocker_inertia_std
  double rocker_inertia_std{0.02};    ///< relative, of the given rocker inertia [-]
  Globals in_force{Globals::Zero()};  ///< to compare with: zero and eccentricities of the parameters in force
};

/// One key of the file that the other commands read.
struct Estimate {
  std::string key, unit;
  double value{}, deviation{};
  double limit{};  ///< deviation that costs some 0.8 % of the wrench's peak, or of the key's own quantity
  std::string meaning;
  double by_blows{};  ///< part of the deviation that more blows would reduce; the rest comes from the given parameters
  std::string hidden_by{};  ///< constant of the hammer file, or level, that causes most of the deviation; empty: the
                            ///< number of blows does
  bool determined() const { return deviation <= limit; }
};

/// Two parameters that the recording can hardly separate.
struct Correlation {
  std::string first, second;
  double value{};
};

/// Mean residual over the crank angle, in equal parts of the turn from -pi to pi.
struct ResidualCurve {
  std::vector<double> mean, deviation;  ///< [rad]; deviation of the mean, NaN where there is none
};

struct Calibration {
  std::string problem;  ///< reason why there is no result; then only `facts`, seconds and blows hold
  SensorFacts facts;
  int direction{1};
  double seconds{};
  std::size_t blows{}, left_out{};
  std::vector<Estimate> estimates;
  std::vector<Correlation> correlations;  ///< beyond 0.9
  std::vector<std::string> remarks;
  bool rod_gives{};             ///< the connecting rod or its pins are elastic
  double mean_square{};         ///< mean square of the residuals over their variance, per degree of freedom
  ResidualCurve before, after;  ///< with the parameters in force, with those found
  double more_blows{};          ///< needed for every key that is not determined; infinity: more do not help

  /// Largest ratio of by_blows to limit of a key; infinity with a problem.
  double worstByBlows() const;
  /// True if more of the recording would not help: the deviation by the number of blows is at most half of each key's
  /// limit. It then adds 12 % to an error that is at the limit for another reason.
  bool isSettled() const { return worstByBlows() <= 0.5; }
};

Calibration calibrate(const std::vector<RecordedSample>& samples, const CalibrationBasis& basis,
                      const Progress& progress = {});

}  // namespace hammer_loads::calibration
