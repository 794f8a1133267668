#include "hammer_loads/pipeline/mode_observer.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/estimation/look_back.h"

namespace hammer_loads {
namespace {

/// Standard deviations of one reading, of its initial offset, and of the offset's random walk in a second.
struct SensorNoise {
  double noise, offset, walk;
};
constexpr SensorNoise kAcceleration{0.3, 0.3, 0.05};  // [m/s2]
// Prior: kAcceleration, kLinksInHull
constexpr SensorNoise kRate{0.005, 0.02, 0.005};  // [rad/s]
// Prior: kRate
constexpr SensorNoise kAngle{2e-4, 0.01, 0.002};  // [rad]
// Prior: kAngle
constexpr SensorNoise kTorque{0.004, 0.02, 0.002};  // parts of the torque that the cylinder's relief valve allows
constexpr double kLinksInHull = 1.0;                // [m/s2]: modes assume the links at their mean position
// Prior: kTorque
constexpr double kMoved = 0.02;  // [rad]: a jump
// Limit: kMoved
constexpr double kOfSample = 0.75;  // part of the step between samples, within which a reading belongs to one

void setNoise(const SensorNoise& sensor, double size, VibrationReading& reading) noexcept {
  reading.noise = size * sensor.noise;
  reading.offset_std = size * sensor.offset;
  reading.offset_walk = size * sensor.walk;
}

}  // namespace

void ModeObserver::imu(Boom& boom, const HeldPose& held, StampNs sample, double step,
                       const StampedImuReading& reading) noexcept {
  imu_.add(reading);
  const double waiting = boom.vibration().identifier()->waiting() - 0.5 * step;
  imu_.takeUpTo(sample - std::llround(waiting / kSecondsPerNs), [&](const StampedImuReading& next) {
    if (!held.isDriven()) update(boom, held, seconds(next.stamp - sample), next.reading);
  });
}

void ModeObserver::update(Boom& boom, const HeldPose& held, double ahead, const ImuReading& reading) const noexcept {
  const Jacobian& J = boom.tipJacobian();
  const Eigen::Vector3d g_T = boom.gravityAtTip(), slow_rate = J.bottomRows<3>() * held.slowRate();
  const auto along = [&](const Eigen::Vector3d& n_T) {
    return tipAccelerationReading(J, imu_position_, n_T, g_T, n_T.dot(reading.specific_force));
  };
  std::array<VibrationReading, kImuChannels> seen{
      along(Eigen::Vector3d::UnitX()), along(Eigen::Vector3d::UnitZ()),
      tipRateReading(J, Eigen::Vector3d::UnitY(), reading.rate.y() - slow_rate.y())};
  for (int i = 0; i < kImuChannels; ++i) {
    VibrationReading& one = seen[static_cast<std::size_t>(i)];
    const bool turns = i == 2;
    one.channel = i;
    one.ahead = ahead;
    one.clock = Clock::kImu;
    one.neglected = turns ? 0.0 : kLinksInHull;
    setNoise(turns ? kRate : kAcceleration, 1.0, one);
  }
  boom.vibration().observe(seen.data(), seen.size());
}

void ModeObserver::joints(Boom& boom, const HeldPose& held, StampNs sample, double step,
                          const JointBuffer& joints) noexcept {
  const JointVector slow_rate = held.slowRate();
  for (std::size_t i = 0; i < boom.cylinders().size(); ++i) {
    const int joint = boom.cylinders()[i].joint();
    const std::optional<JointBuffer::Reading> now = joints.newest(joint);
    JointTrack& track = joints_[i];
    if (!now || now->stamp == track.stamp) continue;
    const double interval = seconds(now->stamp - track.stamp), ahead = seconds(now->stamp - sample);
    const bool jumped =
        !(interval > 0.0) || interval > look_back::kHeld || std::abs(now->position - track.position) > kMoved;
    track.stamp = now->stamp, track.position = now->position;
    if (jumped || held.isDriven() || std::abs(ahead) > kOfSample * step) continue;
    VibrationReading reading = jointAngleReading(joint, now->position - held.slowAngle()[joint]);
    reading.velocity[joint] = ahead;
    SensorNoise sensor = kAngle;
    sensor.walk += std::abs(slow_rate[joint]);
    setNoise(sensor, 1.0, reading);
    boom.vibration().observe(kImuChannels + static_cast<int>(i), reading);
  }
}

void ModeObserver::pressures(Boom& boom, const HeldPose& held, StampNs sample,
                             const CylinderPressures& pressures) noexcept {
  const auto cylinders = boom.cylinders().size();
  std::array<VibrationReading, kMaxJoints> seen;  // readings of one instant
  std::size_t count = 0;
  const auto take = [&] { boom.vibration().observe(seen.data(), count), count = 0; };
  for (std::size_t i = 0; i < cylinders; ++i) {
    if (pressures.count(i) == pressures_[i]) continue;
    pressures_[i] = pressures.count(i);
    const StampNs stamp = pressures.newest(i);
    const std::optional<ChamberPressures> p = pressures.at(i, stamp);
    const Cylinder& cylinder = boom.cylinders()[i];
    const int j = cylinder.joint();
    const CylinderPosition& at = boom.cylinderPosition(i);
    if (!p || at.zero_moment_arm || !boom.vibration().known()) continue;
    const double ahead = seconds(stamp - sample);
    if (count > 0 && ahead != seen[0].ahead) take();
    VibrationReading& reading = seen[count++];
    const double by_oil = forceOf(cylinder, *p) * at.arm;
    reading = oilTorqueReading(j, -by_oil - boom.steadyTorque(j));
    reading.channel = kImuChannels + static_cast<int>(cylinders + i);
    reading.ahead = ahead;
    reading.clock = Clock::kPressures;
    boom.vibration().setSeals(i, sealsOf(cylinder, at.arm, by_oil, held.motion().velocity[j]));
    setNoise(kTorque, cylinder.greatestPush() * std::abs(at.arm), reading);
  }
  take();
}

}  // namespace hammer_loads
