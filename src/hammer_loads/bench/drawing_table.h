/// Errors and deviations where the machine is not the one of its drawing.
#pragma once

#include <array>
#include <cstdint>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/bench/table.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// One machine whose constants were drawn from the deviations of the hammer file; the file is what the pipeline has.
struct DrawingRow {
  using Figure = FigureErrors::Result;
  std::array<Figure, 3> samples;      ///< errors over the peak of force_x, force_z, torque_y
  Figure energy, impulse, amplitude;  ///< relative: of the blow; of Fz over the turn; its peak
  Figure range;                       ///< relative: of Fz's damage-equivalent range at kLifeSlope
};

DrawingRow drawingRow(const Settings& settings, std::uint64_t seed);

/// Each figure over so many drawings.
Table drawingTable(const Settings& settings, int drawings, std::uint64_t first_seed = 1);

}  // namespace hammer_loads::accuracy
