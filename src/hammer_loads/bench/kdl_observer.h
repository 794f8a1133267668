/// Cost table: what KDL's momentum observer makes of the same readings.
#pragma once

#include <optional>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/table.h"
#include "hammer_loads/settings/load.h"
#include "hammer_loads/simulation/session.h"

namespace hammer_loads::accuracy {

/// All that hammer and rock do to the hull, beside its mean: force in its axes, moment about D.
struct OuterLoadErrors {
  SignalError force_x, force_z, moment;
};

/// Gains of the observer [1/s], its only parameters; much larger ones are unstable at 500 Hz.
constexpr double kObserverGains[] = {30.0, 100.0, 300.0, 1000.0};

/// KDL::ChainExternalWrenchEstimator (orocos_kdl 1.5 or newer) at each reading of the pressures from a time to another
/// [s]: joints on the line between their readings, the one after included, which a live node does not have yet; no
/// filter. Empty where KDL has no observer.
std::optional<OuterLoadErrors> kdlErrors(const simulation::Session& session, const Settings& settings, double gain,
                                         double from, double to);
/// The pipeline's, with the same pressures and joints and, where there is one, the hull's IMU, at each crank sample.
OuterLoadErrors pipelineErrors(const simulation::Session& session, const Settings& settings, bool imu, double from,
                               double to);

/// The simulated EO-2621 free and on rock, oil as in the boom file, one pose; the observer with the best of its gains.
Table observerTable();

}  // namespace hammer_loads::accuracy
