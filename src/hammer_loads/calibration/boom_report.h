/// Report of a boom identification: text, boom file and picture.
#pragma once

#include <string>

#include "hammer_loads/calibration/boom_calibration.h"

namespace hammer_loads::calibration {

/// First lines of the files, by which their writer recognises them.
constexpr const char* kBoomYamlBegins = "# Boom of one machine, weighed by calibrate --boom from";
constexpr const char* kBoomSvgBegins = "<svg id=\"hammer_loads_boom_calibration\"";

std::string textOf(const BoomCalibration& calibration);
/// Returns a whole boom file, one `key: value` per line: the given keys, with identified values replaced or appended.
/// Empty if the boom is not determined.
std::string yamlOf(const BoomCalibration& calibration, const std::string& given, const std::string& source);
/// Returns a plot of each cylinder's force residual over its joint angle, before and after the fit.
std::string svgOf(const BoomCalibration& calibration);

}  // namespace hammer_loads::calibration
