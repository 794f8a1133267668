/// Measured load of the hull from a data logger's file.
#pragma once

#include <string>
#include <vector>

#include "hammer_loads/pipeline/reference.h"
#include "hammer_loads/util/checked.h"

namespace hammer_loads {

struct MeasuredLoad {
  StampNs stamp{};
  ReferenceComparison::Values load{};  ///< force x, force z [N], torque y [N m]; NaN: not measured
};

/// Reads a CSV text with a header: `stamp` in seconds since 1970 (UTC), and at least one of force_x, force_z in newtons
/// and torque_y in newton metres, the load on the hull as in ~hull_wrench. Other columns and lines that begin with #
/// are ignored. An empty field is not measured. Problems begin with the line's number. Stamps must increase.
Checked<std::vector<MeasuredLoad>> readReferenceTable(const std::string& csv);

}  // namespace hammer_loads
