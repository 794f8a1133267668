/// Errors and deviations where the machine is not the one of its drawing.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hammer_loads/bench/estimate_errors.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::accuracy {

/// One machine whose constants were drawn from the deviations of the hammer file; the file is what the pipeline has.
struct DrawingRow {
  using Figure = FigureErrors::Result;
  std::uint64_t seed{};
  std::array<Figure, 3> samples;      ///< errors over the peak of force_x, force_z, torque_y
  Figure energy, impulse, amplitude;  ///< relative: of the blow; of Fz over the turn; its peak
  Figure range;                       ///< relative: of Fz's damage-equivalent range at kLifeSlope
};

/// off: times the deviations that the machine is drawn with; the pipeline has the file's.
DrawingRow drawingRow(const Settings& settings, std::uint64_t seed, double off);

std::vector<DrawingRow> drawingTable(const Settings& settings, int drawings, std::uint64_t first_seed = 1);

/// A figure over all drawings.
struct DrawingSummary {
  const char* quantity;
  FigureErrors::Result all;
  double least{1.0};  ///< smallest part within two standard deviations of any drawing
};
std::vector<DrawingSummary> summary(const std::vector<DrawingRow>& rows);

std::string markdown(const std::vector<DrawingSummary>& rows);
std::string json(const std::vector<DrawingSummary>& rows);

}  // namespace hammer_loads::accuracy
