/// Report of a calibration: text, parameter file and picture.
#pragma once

#include <string>

#include "hammer_loads/calibration/calibration.h"

namespace hammer_loads::calibration {

/// First line of the files, by which their writer recognises them.
constexpr const char* kYamlBegins = "# Crank sensor and drive of one machine, found by calibrate from";
constexpr const char* kSvgBegins = "<svg id=\"hammer_loads_calibration\"";

/// Found keys, keys not found with the reason, and the next step: some six lines for a terminal. verbose: then every
/// estimate, correlation and remark.
std::string textOf(const Calibration& calibration, bool verbose = false);
/// Keys that are determined, each with its deviation; for `--params`.
std::string yamlOf(const Calibration& calibration, const std::string& source);
/// Mean residual over the crank angle, before and after, each on a scale of its own.
std::string svgOf(const Calibration& calibration);

}  // namespace hammer_loads::calibration
