#include "hammer_loads/calibration/local_fit.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/calibration/positive_system.h"
#include "hammer_loads/util/median.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads::calibration {
namespace {

constexpr int kIterations = 4;         // Numerical: kIterations
constexpr double kNotExplained = 6.0;  // times the median mean square of the blows

/// Marquardt: a little more of the diagonal.
LocalMatrix damped(const LocalMatrix& matrix, double part) {
  LocalMatrix result = matrix;
  result.diagonal() *= 1.0 + part;
  return result;
}

}  // namespace

Locals limitedLocals(const Locals& step, const Locals& at) {
  double part = 1.0;
  for (const Eigen::Index k : {kSpeedBefore, kSpeedAfter}) {
    if (std::abs(step[k]) > 0.3 * at[k]) part = std::min(part, 0.3 * at[k] / std::abs(step[k]));
  }
  const double most = 0.1 / std::max(at[kSpeedBefore], 1.0);
  if (std::abs(step[kInstant]) > most) part = std::min(part, most / std::abs(step[kInstant]));
  return part * step;
}

void fitLocals(SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise) {
  double cost = fit.cost(model, globals, noise);
  double damping = 1e-3;
  for (int i = 0; i < kIterations; ++i) {
    const NormalEquations e = fit.linearise(model, globals, noise);
    const Locals before = fit.locals();
    bool better = false;
    for (int k = 0; k < 5 && !better; ++k) {
      fit.setLocals(before + limitedLocals(Locals(solved(damped(e.ll, damping), e.l)), before));
      const double now = fit.cost(model, globals, noise);
      better = now < cost;
      if (better) {
        cost = now, damping *= 0.1;
      } else {
        fit.setLocals(before), damping = damping * 10.0 + 1e-6;
      }
    }
    if (!better) return;
  }
}

Reduced reduce(const NormalEquations& e) {
  Reduced r;
  r.inverse = inverseOf(e.ll);
  r.by_global = r.inverse * e.lg;
  r.own = r.inverse * e.l;
  r.matrix = e.gg - e.lg.transpose() * r.by_global;
  r.score = e.g - e.lg.transpose() * r.own;
  r.angle_freedom = (r.inverse * e.ll_angles).trace();
  r.speed_freedom = (r.inverse * e.ll_speeds).trace();
  return r;
}

double meanSquare(const SegmentFit& fit, const SegmentModel& model, const Globals& globals, const Noise& noise) {
  double sum = 0.0, n = 0.0;
  for (const ResidualAt& r : fit.residuals(model, globals, noise)) {
    sum += square(r.angle / r.deviation.angle);
    n += 1.0;
  }
  return sum / n;
}

double mostExplained(const std::vector<double>& mean_squares) {
  return kNotExplained * std::max(medianOf(mean_squares), 0.05);
}

}  // namespace hammer_loads::calibration
