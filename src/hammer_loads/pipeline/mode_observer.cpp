#include "hammer_loads/pipeline/mode_observer.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

/// Standard deviation of one reading, of its offset at the start, and how far that wanders in a second.
struct Doubt {
  double noise, offset, walk;
};
constexpr Doubt kAcceleration{0.3, 0.3, 0.05};    // [m/s2]
constexpr Doubt kRate{0.005, 0.02, 0.005};        // [rad/s]
constexpr Doubt kAngle{2e-4, 0.01, 0.002};        // [rad]
constexpr Doubt kTorque{0.004, 0.02, 0.002};      // of the torque that the cylinder's relief valve allows
constexpr double kLinksInHull = 1.0;              // [m/s2]: modes take the links at the mean of their places
constexpr double kSlowest = 0.01, kMoved = 0.02;  // [s] between joint states; [rad] a jump

void see(Boom& boom, int channel, VibrationReading reading, const Doubt& doubt, double size = 1.0) noexcept {
  reading.noise = size * doubt.noise;
  reading.offset_deviation = size * doubt.offset;
  reading.offset_walk = size * doubt.walk;
  boom.vibration().observe(channel, reading);
}

}  // namespace

void ModeObserver::imu(Boom& boom, const HeldPose& held, const ImuReading& reading) noexcept {
  if (held.isDriven()) return;
  const Jacobian& J = boom.tipJacobian();
  const Eigen::Vector3d g_T = boom.gravityAtTip(), slow_rate = J.bottomRows<3>() * held.slowRate();
  const auto seeUnit = [&](int channel, VibrationReading seen, const Doubt& doubt) {
    seen.clock = Clock::kImu;
    see(boom, channel, seen, doubt);
  };
  const auto seeAcceleration = [&](int channel, const Eigen::Vector3d& n_T) {
    VibrationReading seen = tipAccelerationReading(J, imu_position_, n_T, g_T, n_T.dot(reading.specific_force));
    seen.neglected = kLinksInHull;
    seeUnit(channel, seen, kAcceleration);
  };
  seeAcceleration(0, Eigen::Vector3d::UnitX());
  seeAcceleration(1, Eigen::Vector3d::UnitZ());
  seeUnit(2, tipRateReading(J, Eigen::Vector3d::UnitY(), reading.rate.y() - slow_rate.y()), kRate);
}

void ModeObserver::joints(Boom& boom, const HeldPose& held, StampNs sample, double step,
                          const JointBuffer& joints) noexcept {
  const int count = boom.chain().joints();
  const JointVector slow_rate = held.slowRate();
  for (std::size_t i = 0; i < boom.cylinders().size(); ++i) {
    const int joint = boom.cylinders()[i].joint();
    const std::optional<JointBuffer::Reading> now = joints.newest(joint);
    JointTrack& track = joints_[i];
    if (!now || now->stamp == track.stamp) continue;
    const double interval = seconds(now->stamp - track.stamp), ahead = seconds(now->stamp - sample);
    const bool jumped = !(interval > 0.0) || interval > kSlowest || std::abs(now->position - track.position) > kMoved;
    track.stamp = now->stamp, track.position = now->position;
    if (jumped || held.isDriven() || std::abs(ahead) > 0.75 * step) continue;
    VibrationReading reading = jointAngleReading(count, joint, now->position - held.slowAngle()[joint]);
    reading.velocity[joint] = ahead;
    Doubt doubt = kAngle;
    doubt.walk += std::abs(slow_rate[joint]);
    see(boom, kImuChannels + static_cast<int>(i), reading, doubt);
  }
}

void ModeObserver::pressures(Boom& boom, StampNs sample, const CylinderPressures& pressures) noexcept {
  const auto cylinders = boom.cylinders().size();
  for (std::size_t i = 0; i < cylinders; ++i) {
    if (pressures.count(i) == pressures_[i]) continue;
    pressures_[i] = pressures.count(i);
    const StampNs stamp = pressures.newest(i);
    const std::optional<ChamberPressures> p = pressures.at(i, stamp);
    const Cylinder& cylinder = boom.cylinders()[i];
    const int j = cylinder.joint();
    const CylinderPosition& at = boom.cylinderPosition(i);
    if (!p || at.dead_centre || !boom.vibration().known()) continue;
    const double torque = -forceOf(cylinder, *p) * at.arm - boom.steadyTorque(j);
    VibrationReading reading = oilTorqueReading(boom.chain().joints(), j, torque);
    reading.ahead = seconds(stamp - sample);
    reading.clock = Clock::kPressures;
    see(boom, kImuChannels + static_cast<int>(cylinders + i), reading, kTorque,
        cylinder.greatestPush() * std::abs(at.arm));
  }
}

}  // namespace hammer_loads
