/// A blow on a machine with an elastic rod, as a picture shows it: the true force and what the levels say of it.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/linkage/level.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// Force z on the hull [N] by the time from the first touch [s]; of an estimate with its standard deviation [N].
struct ForceTrace {
  std::vector<double> time, force_z, deviation;
};

struct BlowTrace {
  std::string machine;  ///< name in elasticKinds()
  ForceTrace truth;     ///< each 0.1 ms, without deviation
  ForceTrace linkage, elastic;
};

/// The first blow once the rod is known, from 5 ms before it to 45 ms after it.
BlowTrace blowTrace(const Settings& settings);

/// Trace as a JSON object.
std::string json(const BlowTrace& trace);

}  // namespace hammer_loads::accuracy
