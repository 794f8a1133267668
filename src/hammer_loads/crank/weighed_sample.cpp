#include "hammer_loads/crank/weighed_sample.h"

namespace hammer_loads {

Innovation WeighedSample::ofAngle(const CrankBelief& belief) const noexcept {
  const double offset = belief.state.position.angle.offset, variance = angleVariance(belief.state.speed);
  return {CrankAngle::wrapToPi(angle - offset), belief.covariance(CrankBelief::kAngle, CrankBelief::kAngle) + variance,
          variance, SensorErrors::ofAngle(offset)};
}

/// The stamp's jitter counts by the acceleration; it is not computed for nothing.
Innovation WeighedSample::ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept {
  const ShaftState& state = belief.state;
  double known = belief.covariance(CrankBelief::kSpeed, CrankBelief::kSpeed);
  if (timing_variance > 0.0) {
    const double change = acceleration(model(state.position.angle), state);
    known += change * change * timing_variance;
  }
  return {*speed - state.speed, known + speed_variance, speed_variance,
          SensorErrors::ofSpeed(state.position.angle.offset, state.speed)};
}

}  // namespace hammer_loads
