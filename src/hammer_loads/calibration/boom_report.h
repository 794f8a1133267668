/// Report of a weighed boom: text, boom file and picture.
#pragma once

#include <string>

#include "hammer_loads/calibration/boom_calibration.h"

namespace hammer_loads::calibration {

/// First line of the files, by which their writer recognises them.
constexpr const char* kBoomYamlBegins = "# Boom of one machine, weighed by calibrate --boom from";
constexpr const char* kBoomSvgBegins = "<svg id=\"hammer_loads_boom_calibration\"";

std::string textOf(const BoomCalibration& calibration);
/// A whole boom file: the keys given, one `key: value` a line, with those found in place of theirs or after them. Empty
/// where weights of joints are not determined.
std::string yamlOf(const BoomCalibration& calibration, const std::string& given, const std::string& source);
/// Residual of each cylinder's force over its joint's angle, before and after.
std::string svgOf(const BoomCalibration& calibration);

}  // namespace hammer_loads::calibration
