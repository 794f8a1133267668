/// The three calibrations of the command calibrate.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {

struct CalibrateArguments {
  std::vector<std::string> bags, params;
  std::string output, urdf;
  bool force{}, boom{};
  double rocker_std{0.02};           ///< standard deviation of the given rocker inertia, relative
  bool verbose{};                    ///< every estimate of the crank in the report
  std::vector<std::string> weighed;  ///< bags with a weight on the tip; none: it hangs there in all, if it is given
  std::optional<double> weight;      ///< [kg]
  std::vector<double> at;            ///< x and z of its centre of mass in the tip's frame [m]

  /// Name of the recording in the files.
  std::string source() const;
};

/// Results of a calibration: texts of the files; empty ones with a problem or where nothing is determined.
struct CalibrationTexts {
  std::vector<std::string> problems;  ///< one line each
  std::string words, yaml, picture;
};

/// A recording of the hammer at work in, the crank sensor's place and the drive's inertia out. settings: those of the
/// recording.
CalibrationTexts calibrateCrank(const BagInputs& inputs, const Settings& settings, const CalibrateArguments& given);

/// --boom: bags of the boom's free movement in, each a recording or the next split of the one before; a whole boom file
/// out. settings: those of the recording.
CalibrationTexts calibrateBoom(const Settings& settings, const CalibrateArguments& given);

/// --linkage: a table of stroke and angle in, the lengths of a bucket linkage out. Returns the exit code; empty if the
/// command line does not ask for it.
std::optional<int> calibrateLinkage(int argc, const char* const* argv);

/// Reads bags. Returns one line why they cannot be read; empty: they were.
std::string readOrSay(const BagInputs& inputs, const std::function<void()>& read);

/// Prints the words; fills the files with YAML and picture, then gives all their names. Exit code.
int finishCalibration(const CalibrationTexts& texts, std::vector<OutputFile>& files);

}  // namespace hammer_loads
