/// Errors and deviations where the machine is not the one of its drawing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// One machine whose constants were drawn from the deviations of the hammer file; the file is what the pipeline has.
struct DrawingRow {
  static constexpr int kQuantities = 3;  ///< force_x, force_z, torque_y
  std::uint64_t seed{};
  double rms[kQuantities]{};      ///< of the peak of each
  double covered[kQuantities]{};  ///< part of the samples within two deviations
  double said[kQuantities]{};     ///< root of the mean squared deviation, of the peak
  /// Root of the mean squared relative error, and the part of the turns within two deviations.
  struct OfTurns {
    double rms{}, covered{};
  };
  OfTurns energy, impulse, amplitude;       ///< of the blow; of Fz over the turn; its peak
  double range_error{}, range_deviation{};  ///< of Fz's damage-equivalent range at kLifeSlope, relative
};

/// off: times the deviations that the machine is drawn with; the pipeline has the file's.
DrawingRow drawingRow(const Settings& settings, std::uint64_t seed, double off);

std::vector<DrawingRow> drawingTable(const Settings& settings, int drawings);

std::string markdown(const std::vector<DrawingRow>& rows);

}  // namespace hammer_loads::accuracy
