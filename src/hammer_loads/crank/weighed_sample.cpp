#include "hammer_loads/crank/weighed_sample.h"

#include "hammer_loads/util/square.h"

namespace hammer_loads {

Innovation WeighedSample::ofAngle(const CrankBelief& belief) const noexcept {
  const double offset = belief.encoderOffset(), variance = angleVariance(belief.encoderSpeed());
  return {CrankAngle::wrapToPi(angle - offset), belief.encoderVariance(CrankBelief::kAngle) + variance, variance,
          ConstantErrors::ofAngle({offset, belief.encoderSpeed(), 0.0})};
}

/// An error of the stamp counts by the acceleration.
Innovation WeighedSample::ofSpeed(const CrankBelief& belief, const ShaftModel& model) const noexcept {
  const ShaftState& state = belief.state;
  const ShaftLoad load = model(state.position.angle);
  const double change = belief.motor ? motorAcceleration(*model.coupling(), load, state) : acceleration(load, state);
  const double noise = speed_variance + square(change) * timing_variance;
  const auto by_error = ConstantErrors::ofSpeed({belief.encoderOffset(), belief.encoderSpeed(), change});
  const double of_constants =
      of_speed ? (by_error - belief.encoderByError(CrankBelief::kSpeed)).cwiseAbs2().dot(*of_speed) : 0.0;
  return {*speed - belief.encoderSpeed(), belief.encoderVariance(CrankBelief::kSpeed) + noise + of_constants, noise,
          by_error};
}

}  // namespace hammer_loads
