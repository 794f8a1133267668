/// Report of a calibration: text, parameter file and picture.
#pragma once

#include <string>

#include "hammer_loads/calibration/calibration.h"

namespace hammer_loads::calibration {

/// First lines of the files, by which their writer recognises them.
constexpr const char* kYamlBegins = "# Crank sensor and drive of one machine, found by calibrate from";
constexpr const char* kSvgBegins = "<svg id=\"hammer_loads_calibration\"";

/// Returns keys found, keys not found with the reason, and the next step: some six lines for a terminal. verbose: every
/// estimate, correlation and remark follows.
std::string textOf(const Calibration& calibration, bool verbose = false);
/// Returns the determined keys, each with its deviation, for `--params`.
std::string yamlOf(const Calibration& calibration, const std::string& source);
/// Returns a plot of the mean residual over the crank angle, before and after the fit, each on its own scale.
std::string svgOf(const Calibration& calibration);

}  // namespace hammer_loads::calibration
