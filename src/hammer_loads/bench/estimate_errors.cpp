#include "hammer_loads/bench/estimate_errors.h"

#include "hammer_loads/life/damage.h"
#include "hammer_loads/util/format.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads::accuracy {
namespace {

template <typename Cycles>
double equivalentRange(const Cycles& cycles) {
  return life::equivalentLoad(life::rangesAndMeans(cycles), kLifeSlope, 1.0, {}).value;
}

/// own, common: of the counted range [-].
LifeFigure figureBy(double counted, double right, double own, double common) {
  const double ratio = counted / right;
  return {ratio - 1.0, ratio * own, ratio * common};
}

}  // namespace

void LifeError::endTurn() {
  const double range = turn_.range();
  const life::LoadError stated = turn_.ofRange();
  turn_ = {};
  if (!(range > 0.0 && stated.own >= 0.0 && stated.common >= 0.0)) return;
  square_ += square(range), own_ += range * stated.own, common_ += range * stated.common;
}

LifeFigure LifeError::figure() const {
  return figureBy(equivalentRange(estimated_), equivalentRange(right_), own_ / square_, common_ / square_);
}

LifeFigure figureOf(const life::CycleCount& counted, const life::ExactCycles& right) {
  const life::RangeDeviation stated = life::rangeDeviation(counted);
  return figureBy(equivalentRange(counted), equivalentRange(right), stated.own, stated.common);
}

std::string json(const LifeFigure& figure) {
  return "{\"error\": " + jsonNumber(figure.error) + ", \"own\": " + jsonNumber(figure.own) +
         ", \"common\": " + jsonNumber(figure.common) + "}";
}

}  // namespace hammer_loads::accuracy
