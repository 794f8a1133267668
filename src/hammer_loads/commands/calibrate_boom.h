/// calibrate --boom: a recording of the boom's free movement in, a whole boom file out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"

namespace hammer_loads {

struct BoomCalibrationJob {
  std::vector<std::string> bags;     ///< each a recording, or the next split of the one before
  std::vector<std::string> weighed;  ///< bags with a weight on the tip; none: it hangs there in all, if it is given
  std::optional<double> weight;      ///< [kg]
  std::vector<double> at;            ///< x and z of its centre of mass in the tip's frame [m]
};

/// Results of a calibration: texts of the files; empty ones with a problem or where nothing is determined.
struct CalibrationTexts {
  std::vector<std::string> problems;  ///< one line each
  std::string words, yaml, picture;
};

/// settings: those of the recording; bags: their names in the file.
CalibrationTexts calibrateBoom(const Settings& settings, const BoomCalibrationJob& job, const std::string& source);

}  // namespace hammer_loads
