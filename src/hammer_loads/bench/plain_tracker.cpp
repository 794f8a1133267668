#include "hammer_loads/bench/plain_tracker.h"

#include <cmath>

namespace hammer_loads::accuracy {
namespace {

constexpr double kFurthest = 200.0;  // [rad] between two samples: some 30 turns; further ones look the same

}  // namespace

/// Angle and speed of the crank from those of its sensor.
CrankSample PlainTracker::ofCrank(const CrankSample& reading) noexcept {
  CrankSample sample{encoder_.angle(reading.angle), reading.speed};
  if (sample.speed) sample.speed = encoder_.speed(sample.angle, *reading.speed);
  return sample;
}

void PlainTracker::start(const CrankSample& reading) noexcept {
  const CrankSample sample = ofCrank(reading);
  now_ = {{0, CrankAngle::fromAngle(sample.angle)}, sample.speed.value_or(0.0), 0.0};
  has_speed_ = sample.speed.has_value();
}

Tracking PlainTracker::update(double dt, const CrankSample& reading) noexcept {
  const CrankSample sample = ofCrank(reading);
  before_ = now_;
  step_ = dt;
  const double measured = CrankAngle::fromAngle(sample.angle).offset;
  // The turn between two samples is the one nearest to what the earlier speed predicts.
  const double predicted = now_.speed * dt;
  const double turned =
      predicted + CrankAngle::wrapToPi(measured - now_.position.angle.offset - CrankAngle::wrapToPi(predicted));
  now_.position.turn(turned);
  now_.speed = sample.speed.value_or(turned / dt);
  if (acceleration_ == Acceleration::kDifference && has_speed_) now_.acceleration = (now_.speed - before_.speed) / dt;
  const bool continued = has_speed_ && std::abs(turned - predicted) < 0.25 * kTwoPi && std::abs(turned) < kFurthest;
  has_speed_ = true;
  return continued ? Tracking::kContinued : Tracking::kRestarted;
}

CrankEstimate PlainTracker::between(double dt) const noexcept {
  if (dt >= step_) return now_;
  const double x = dt / step_;
  const double turned = difference(now_.position, before_.position);
  const double blend = x * x * (3.0 - 2.0 * x);
  CrankEstimate estimate = before_;
  estimate.position.turn(blend * turned + step_ * x * (1.0 - x) * ((1.0 - x) * before_.speed - x * now_.speed));
  estimate.speed += x * (now_.speed - before_.speed);
  estimate.acceleration += x * (now_.acceleration - before_.acceleration);
  return estimate;
}

TrackerMaker plainTracker(PlainTracker::Acceleration acceleration) {
  return [acceleration](const Mechanism& mechanism, const PipelineSettings& s) {
    return std::make_unique<PlainTracker>(acceleration, s.crank_angle_resolution, mechanism.parameters().drive_inertia,
                                          s.crank_sensor);
  };
}

}  // namespace hammer_loads::accuracy
