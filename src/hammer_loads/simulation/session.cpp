#include "hammer_loads/simulation/session.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads::simulation {
namespace {

constexpr double kTwoPi = 6.283185307179586232;
constexpr double kJointLag = 0.005;  // first joint sample [s], so that the two streams do not coincide

}  // namespace

SessionStream::SessionStream(const MachineSettings& settings) : machine_(settings), noise_(settings.seed) {
  planSample();
}

/// Instant and errors of the next crank sample. Draws the same numbers whatever is measured or lost, so that such
/// settings do not change the rest of the noise. Instants are whole nanoseconds, hence exact in a stamp.
void SessionStream::planSample() noexcept {
  const CrankSensorSettings& sensor = machine_.settings().crank;
  ++samples_;
  const double jitter = std::clamp(sensor.jitter * noise_() * sensor.rate, -0.45, 0.45);
  next_sample_ = std::round((static_cast<double>(samples_) + jitter) / sensor.rate * 1e9) * 1e-9;
  stamp_error_ = sensor.stamp_noise * noise_();
  speed_error_ = sensor.speed_noise * noise_();
}

void SessionStream::advanceTo(double time, Session& session) {
  const MachineSettings& settings = machine_.settings();
  const auto joint_time = [&] { return kJointLag + static_cast<double>(joint_samples_) / settings.joint_rate; };
  while (std::min(next_sample_, joint_time()) <= time) {
    if (joint_time() <= next_sample_) {
      session.joints.push_back(readJoints(joint_time()));
      ++joint_samples_;
      continue;
    }
    const auto& lost = settings.crank.drop_outs;
    const bool dropped = std::any_of(lost.begin(), lost.end(), [&](const CrankSensorSettings::Interval& interval) {
      return next_sample_ >= interval.from && next_sample_ < interval.to;
    });
    if (!dropped) {
      machine_.advanceTo(next_sample_);
      const CrankTruth truth = machine_.truth();
      session.truth.push_back(truth);
      session.crank.push_back(read(truth, stamp_error_, speed_error_));
    }
    planSample();
  }
  machine_.advanceTo(time);
  const std::vector<BlowTruth> blows = machine_.takeBlows();
  session.blows.insert(session.blows.end(), blows.begin(), blows.end());
}

CrankReading SessionStream::read(const CrankTruth& truth, double stamp_error, double speed_error) const noexcept {
  const CrankSensorSettings& sensor = machine_.settings().crank;
  CrankReading reading;
  reading.stamp = stampAt(truth.time + stamp_error);
  const std::int64_t turn = sensor.unwound ? truth.turn : 0;
  if (sensor.counts > 0) {
    const double count = kTwoPi / sensor.counts;
    // The turn's last count is the encoder's last, however close the angle is to 2 pi.
    const std::int64_t passed =
        std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(truth.angle / count)), sensor.counts - 1);
    reading.angle = static_cast<double>(turn * sensor.counts + passed) * count;
  } else {
    reading.angle = static_cast<double>(turn) * kTwoPi + truth.angle;
  }
  if (sensor.speed) reading.speed = truth.speed + speed_error;
  return reading;
}

JointReading SessionStream::readJoints(double time) const noexcept {
  JointReading reading;
  reading.stamp = stampAt(time);
  const auto& boom = machine_.settings().boom;
  for (std::size_t i = 0; i < boom.size(); ++i) {
    const double rate = kTwoPi / boom[i].period, angle = rate * time + boom[i].phase;
    reading.position[i] = boom[i].mean + boom[i].amplitude * std::sin(angle);
    reading.velocity[i] = boom[i].amplitude * rate * std::cos(angle);
  }
  return reading;
}

std::int64_t SessionStream::stampAt(double time) const noexcept {
  return machine_.settings().start_stamp + static_cast<std::int64_t>(std::llround(time * 1e9));
}

Session recordSession(const MachineSettings& settings) {
  Session session;
  SessionStream stream(settings);
  stream.advanceTo(settings.duration, session);
  return session;
}

}  // namespace hammer_loads::simulation
