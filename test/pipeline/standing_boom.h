/// A boom at the working pose that is followed: a sample every millisecond.
#pragma once

#include <utility>
#include <vector>

#include "boom/booms.h"
#include "hammer_loads/pipeline/boom_follower.h"
#include "hammer_loads/util/constants.h"
#include "support/constants.h"

namespace hammer_loads::test {

constexpr double kStrikingDistance = 0.1975;
inline const std::vector<double> kWorking{0.2, -0.35, 1.20, -0.85};

inline PipelineSettings modelled(BoomModel model) {
  PipelineSettings s;
  s.boom = model;
  s.joint_max_age = 0.2;
  s.gravity = kGravity;
  s.boom_acceleration = BoomAcceleration::kDifference;
  return s;
}

/// A step without blows under a steady load.
inline WrenchHistory steadyStep(double duration, const HullWrench& w) {
  WrenchHistory step;
  step.count = 1;
  step.pieces[0].duration = duration;
  step.pieces[0].from = step.pieces[0].to = step.pieces[0].mean = w;
  return step;
}

inline HalfSinePulse pulseOf(double length) {
  HalfSinePulse pulse;
  pulse.amplitude = 8e3;
  pulse.frequency = kPi / length;
  return pulse;
}

/// A boom that stands at the working pose; a sample every millisecond.
class Follower {
 public:
  explicit Follower(BoomModel model, Boom boom = shippedBoom())
      : follower(std::move(boom), modelled(model), kStrikingDistance) {}

  const BoomState& sample(const HullWrench& w, const WrenchHistory& step, int ms = 1) {
    now += ms * kMs;
    follower.jointStates(now, kFour, kWorking, {});
    return follower.sample({now, w}, step);
  }
  const BoomState& sample(const HullWrench& w) { return sample(w, steadyStep(1e-3, w)); }

  BoomFollower follower;
  StampNs now{};
};

constexpr HullWrench kLoad{-900.0, 7000.0, 300.0};

}  // namespace hammer_loads::test
