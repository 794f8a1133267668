#include "hammer_loads/simulation/session.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hammer_loads::simulation {
namespace {

constexpr double kTwoPi = 6.283185307179586232;
constexpr double kJointLag = 0.005;  // first joint sample [s], so that the two streams do not coincide
constexpr std::uint64_t kMessageSeed = 0xbf58476d1ce4e5b9;

bool isPlain(const CrankSensorSettings& sensor) noexcept {
  return sensor.zero == 0.0 && sensor.direction == 1 && sensor.ratio == 1.0 && sensor.eccentricity[0].amount == 0.0 &&
         sensor.eccentricity[1].amount == 0.0;
}

bool stampsAreInstants(const CrankSensorSettings& sensor) noexcept {
  return sensor.stamp_noise == 0.0 && sensor.stamp_step == 0.0 && sensor.burst <= 1;
}

/// What the encoder shows of its own and the crank's angle, over many turns (contract, "Crank sensor").
struct Encoded {
  double angle, speed;
};

Encoded encoded(const CrankSensorSettings& sensor, double angle, double speed) noexcept {
  double seen = angle, slope = 1.0;
  for (int n = 1; n <= 2; ++n) {
    const Eccentricity& e = sensor.eccentricity[n - 1];
    seen += e.amount * (std::sin(n * angle + e.phase) - std::sin(e.phase));
    slope += n * e.amount * std::cos(n * angle + e.phase);
  }
  const double factor = sensor.direction * sensor.ratio;
  return {sensor.zero + factor * seen, factor * slope * speed};
}

}  // namespace

SessionStream::SessionStream(const MachineSettings& settings)
    : machine_(settings), noise_(settings.seed), message_draws_(settings.seed ^ kMessageSeed) {
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
  if (sensor.stamps_late) stamp_error_ = std::abs(stamp_error_);
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
      take(session);
    }
    planSample();
  }
  machine_.advanceTo(time);
  const std::vector<BlowTruth> blows = machine_.takeBlows();
  session.blows.insert(session.blows.end(), blows.begin(), blows.end());
}

/// Whole bursts arrive at once, with the stamp of their last sample.
void SessionStream::take(Session& session) {
  const CrankSensorSettings& sensor = machine_.settings().crank;
  const CrankTruth truth = machine_.truth();
  burst_.push_back({read(truth, stamp_error_, speed_error_), truth, message_draws_.uniform() < sensor.duplicate_share});
  if (static_cast<int>(burst_.size()) < sensor.burst) return;
  for (Taken& sample : burst_) {
    sample.reading.stamp = burst_.back().reading.stamp;
    for (int i = 0; i < 1 + sample.twice; ++i) {
      session.crank.push_back(sample.reading);
      session.truth.push_back(sample.truth);
      session.taken.push_back(sample.truth.time);
    }
  }
  burst_.clear();
}

CrankReading SessionStream::read(const CrankTruth& truth, double stamp_error, double speed_error) const noexcept {
  const CrankSensorSettings& sensor = machine_.settings().crank;
  CrankReading reading;
  reading.stamp = stampAt(truth.time + sensor.latency + stamp_error);
  if (sensor.stamp_step > 0.0) {
    const auto step = static_cast<std::int64_t>(std::llround(sensor.stamp_step * 1e9));
    reading.stamp -= reading.stamp % step;
  }
  const std::int64_t turn = sensor.unwound ? truth.turn : 0;
  if (!isPlain(sensor) || truth.twist != 0.0) {
    const double whole = kTwoPi * static_cast<double>(truth.turn);
    const Encoded shown = encoded(sensor, whole + truth.angle + truth.twist, truth.motor_speed);
    const double count = kTwoPi / std::max(sensor.counts, 1);
    const double seen = sensor.counts > 0 ? std::floor(shown.angle / count) * count : shown.angle;
    reading.angle = sensor.unwound ? seen : seen - kTwoPi * std::floor((seen + 1e-9) / kTwoPi);
    if (sensor.speed) reading.speed = shown.speed + speed_error;
    return reading;
  }
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

/// Visits the instants in their order in time.
std::vector<CrankTruth> truthAt(const MachineSettings& settings, const std::vector<double>& times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  std::vector<CrankTruth> truth(times.size());
  WorkingMachine machine(settings);
  for (const std::size_t i : order) {
    machine.advanceTo(times[i]);
    truth[i] = machine.truth();
  }
  return truth;
}

Session recordSession(const MachineSettings& settings) {
  Session session;
  SessionStream stream(settings);
  stream.advanceTo(settings.duration, session);
  if (stampsAreInstants(settings.crank)) return session;
  std::vector<double> times;
  for (const CrankReading& reading : session.crank)
    times.push_back(1e-9 * static_cast<double>(reading.stamp - settings.start_stamp) - settings.crank.latency);
  session.truth = truthAt(settings, times);
  return session;
}

}  // namespace hammer_loads::simulation
