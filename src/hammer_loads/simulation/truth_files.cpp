#include "hammer_loads/simulation/truth_files.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "hammer_loads/util/format.h"

namespace hammer_loads::simulation {
namespace {

std::ofstream opened(const std::string& path, const char* header) {
  std::ofstream file(path);
  if (!(file << header << '\n')) throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
  return file;
}

/// All nanoseconds, which a double does not hold.
std::string stampText(std::int64_t nanoseconds) {
  constexpr std::int64_t kGiga = 1'000'000'000;
  return format("%lld.%09lld", static_cast<long long>(nanoseconds / kGiga),
                static_cast<long long>(nanoseconds % kGiga));
}

}  // namespace

TruthFiles::TruthFiles(const std::string& prefix)
    : samples_(opened(prefix + "_samples.csv", "stamp_s,force_x_N,force_z_N,torque_y_Nm")),
      blows_(opened(prefix + "_blows.csv",
                    "stamp_s,energy_J,tool_impulse_Ns,rocker_speed_before_rad_s,rocker_speed_after_rad_s")) {}

void TruthFiles::write(const Session& session, std::int64_t start_stamp) {
  const auto stamp = [start_stamp](double time) { return stampText(start_stamp + std::llround(time * 1e9)); };
  for (const CrankTruth& truth : session.truth)
    samples_ << stamp(truth.time)
             << format(",%.9g,%.9g,%.9g\n", truth.load.force_x, truth.load.force_z,
                       truth.load.torque_y + truth.drive_reaction_y);
  for (const BlowTruth& blow : session.blows)
    blows_ << stamp(blow.time)
           << format(",%.9g,%.9g,%.9g,%.9g\n", blow.strike.energy, blow.strike.tool_impulse,
                     blow.strike.rocker_speed_before, blow.strike.rocker_speed_after);
}

}  // namespace hammer_loads::simulation
