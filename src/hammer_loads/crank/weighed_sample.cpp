#include "hammer_loads/crank/weighed_sample.h"

namespace hammer_loads {

Innovation WeighedSample::ofAngle(const CrankBelief& belief) const noexcept {
  const double offset = belief.encoderOffset(), variance = angleVariance(belief.encoderSpeed());
  return {CrankAngle::wrapToPi(angle - offset), belief.encoderVariance(CrankBelief::kAngle) + variance, variance,
          ConstantErrors::ofAngle(offset)};
}

/// The stamp's jitter counts by the acceleration; it is not computed for nothing.
Innovation WeighedSample::ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept {
  const ShaftState& state = belief.state;
  double known = belief.encoderVariance(CrankBelief::kSpeed);
  if (timing_variance > 0.0) {
    const ShaftLoad load = model(state.position.angle);
    const double change = belief.motor ? motorAcceleration(*model.coupling(), load, state) : acceleration(load, state);
    known += change * change * timing_variance;
  }
  return {*speed - belief.encoderSpeed(), known + speed_variance, speed_variance,
          ConstantErrors::ofSpeed(belief.encoderOffset(), belief.encoderSpeed())};
}

}  // namespace hammer_loads
