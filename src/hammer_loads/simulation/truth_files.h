/// True loads and blows of a simulated machine as two CSV files, to compare estimates with.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "hammer_loads/simulation/session.h"

namespace hammer_loads::simulation {

/// PREFIX_samples.csv holds the load on the hull at the instants of the crank readings, PREFIX_blows.csv the blows.
/// Stamps are those of the session [s]; a load is that of links and drive about D in axes of hammer_hull [N], [N m].
class TruthFiles {
 public:
  /// Replaces the files. Throws std::runtime_error when one cannot be written.
  explicit TruthFiles(const std::string& prefix);

  /// Appends a session's truth. start_stamp: of t = 0 [ns].
  void write(const Session& session, std::int64_t start_stamp);

 private:
  std::ofstream samples_, blows_;
};

}  // namespace hammer_loads::simulation
