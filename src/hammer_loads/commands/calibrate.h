/// The three calibrations of the command calibrate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

struct CrankCalibrationJob {
  std::string recording;    ///< name in the report
  double rocker_std{0.02};  ///< standard deviation of the given rocker inertia, relative
  bool verbose{};           ///< every estimate in the report
};

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

/// A recording of the hammer at work in, the crank sensor's place and the drive's inertia out. settings: those of the
/// recording. source: its name in the file.
CalibrationTexts calibrateCrank(const BagInputs& inputs, const Settings& settings, const CrankCalibrationJob& job,
                                const std::string& source);

/// --boom: a recording of the boom's free movement in, a whole boom file out. settings: those of the recording. source:
/// its name in the file.
CalibrationTexts calibrateBoom(const Settings& settings, const BoomCalibrationJob& job, const std::string& source);

/// Returns true if the command line asks for --linkage: a table of stroke and angle in, the lengths of a bucket linkage
/// out.
bool asksForLinkage(int argc, const char* const* argv);
/// Exit code.
int calibrateLinkage(int argc, const char* const* argv);

}  // namespace hammer_loads
