/// Calibration of the crank's sensor and of the drive's inertia, from a recording at work.
#pragma once

#include <vector>

#include "hammer_loads/calibration/findings.h"
#include "hammer_loads/calibration/joint_fit.h"
#include "hammer_loads/crank/crank_filter.h"

namespace hammer_loads::calibration {

/// Given parameters.
struct CalibrationBasis {
  const Mechanism& mechanism;
  Level level;
  CrankFilterSettings filter;  ///< filter settings with the current parameters, including the encoder's ratio
  // Prior: rocker_inertia_std
  double rocker_inertia_std{0.02};  ///< relative standard deviation of the given rocker inertia [-]

  double ratio() const { return filter.sensor.place().ratio; }  ///< encoder revolutions per crank revolution [-]
};

/// Mean residual over the crank angle, in equal parts of the revolution from -pi to pi.
struct ResidualCurve {
  std::vector<double> mean, deviation;  ///< [rad]; standard deviation of the mean, NaN with too few readings
};

/// Result of a calibration. With a problem, only `facts`, seconds and blows are valid.
struct Calibration : Findings {
  SensorFacts facts;
  double seconds{};
  std::size_t blows{}, left_out{};
  bool rod_is_elastic{};        ///< the connecting rod or its pins are elastic
  double mean_square{};         ///< mean square of the residuals over their variance, per degree of freedom
  ResidualCurve before, after;  ///< with the current parameters, with the identified ones
  double more_blows{};          ///< blows needed to determine every key; infinity: more do not help

  /// Returns the largest ratio of by_blows to limit of a key; infinity with a problem.
  double worstByBlows() const;
  /// Returns true if more of the recording would not help: by_blows is at most half of each key's limit. It then adds
  /// 12 % to an error that is at the limit for another reason.
  bool isSettled() const { return worstByBlows() <= 0.5; }
};

Calibration calibrate(const std::vector<RecordedSample>& samples, const CalibrationBasis& basis,
                      const Progress& progress = {});

}  // namespace hammer_loads::calibration
