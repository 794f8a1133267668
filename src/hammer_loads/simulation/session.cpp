#include "hammer_loads/simulation/session.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "hammer_loads/util/constants.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kJointLag = 0.005;  // first joint sample [s], so that the two streams do not coincide
constexpr double kImuLag = 0.0004, kPressureLag = 0.0007;  // first samples of the other streams [s], likewise distinct
constexpr std::uint64_t kMessageSeed = 0xbf58476d1ce4e5b9, kJointSeed = 0x94d049bb133111eb;
constexpr std::uint64_t kLossSeed = 0x2545f4914f6cdd1d;
constexpr double kSensorStep = 1e-4;  // step in which the input of a low-pass is taken as linear [s]
constexpr std::uint64_t kBusSeed = 0x8cb92ba72f3d8dd7;
constexpr std::uint64_t kDriverSeed = 0xe7037ed1a0b428db, kBoomDriverSeed = 0x589965cc75374cc3;
constexpr std::uint64_t kImuSeed = 0xd6e8feb86659fd93, kPressureSeed = 0xa0761d6478bd642f;

std::variant<WorkingMachine, ElasticMachine, HammerOnBoom> machineOf(const MachineSettings& settings) {
  if (settings.on_boom.on) return HammerOnBoom(settings);
  if (settings.rod.stiffness > 0.0) return ElasticMachine(settings);
  return WorkingMachine(settings);
}

std::array<LowPass, 6> hosesOf(const OnBoomSettings& s) {
  const LowPass hose(s.on && s.pressures.rate > 0.0 ? s.pressures.hose_lag : 0.0);
  return {hose, hose, hose, hose, hose, hose};
}

bool isPlain(const CrankSensorSettings& sensor) noexcept {
  return sensor.zero == 0.0 && sensor.direction == 1 && sensor.ratio == 1.0 && sensor.eccentricity[0].amount == 0.0 &&
         sensor.eccentricity[1].amount == 0.0 && sensor.angle_lag == 0.0 && sensor.slip.amount == 0.0 &&
         sensor.hysteresis == 0.0 && sensor.task_period == 0.0;
}

bool stampsAreInstants(const CrankSensorSettings& sensor) noexcept {
  return sensor.stamp_noise == 0.0 && sensor.driver.areExact() && sensor.stamp_step == 0.0 && sensor.burst <= 1;
}

/// Returns the reading of the encoder before any filter.
EncoderReading encoded(const CrankSensorSettings& sensor, const CrankTruth& truth) noexcept {
  const double whole = kTwoPi * static_cast<double>(truth.turn), angle = whole + truth.angle + truth.twist;
  double seen = angle, slope = 1.0;
  for (int n = 1; n <= 2; ++n) {
    const Eccentricity& e = sensor.eccentricity[n - 1];
    seen += e.amount * (std::sin(n * angle + e.phase) - std::sin(e.phase));
    slope += n * e.amount * std::cos(n * angle + e.phase);
  }
  const double factor = sensor.direction * sensor.ratio;
  return {sensor.zero + factor * seen, factor * slope * truth.motor_speed};
}

}  // namespace

double SessionStream::Ticks::next() const noexcept {
  return rate > 0.0 ? first + static_cast<double>(count) / rate : std::numeric_limits<double>::infinity();
}

SessionStream::SessionStream(const MachineSettings& settings)
    : settings_(settings),
      machine_(machineOf(settings)),
      noise_(settings.seed),
      message_draws_(settings.seed ^ kMessageSeed),
      loss_draws_(settings.seed ^ kLossSeed),
      joint_noise_(settings.seed ^ kJointSeed),
      imu_noise_(settings.seed ^ kImuSeed),
      pressure_noise_(settings.seed ^ kPressureSeed),
      bus_draws_(settings.seed ^ kBusSeed),
      driver_draws_(settings.seed ^ kDriverSeed),
      boom_driver_draws_(settings.seed ^ kBoomDriverSeed),
      angle_(settings.crank.angle_lag),
      speed_(settings.crank.speed_lag),
      hoses_(hosesOf(settings.on_boom)),
      joints_{kJointLag, settings.joint_rate, 0},
      imu_{kImuLag, settings.on_boom.on ? settings.on_boom.imu.rate : 0.0, 0},
      pressures_{kPressureLag, settings.on_boom.on ? settings.on_boom.pressures.rate : 0.0, 0} {
  planSample();
}

/// Draws instant and errors of the next crank sample. The draws do not depend on what is measured or lost, so that such
/// settings do not change the rest of the noise. Instants are whole nanoseconds, hence exact in a stamp.
void SessionStream::planSample() noexcept {
  const CrankSensorSettings& sensor = settings_.crank;
  ++samples_;
  const double jitter = std::clamp(sensor.jitter * noise_() * sensor.rate, -0.45, 0.45);
  next_sample_ = std::round((static_cast<double>(samples_) + jitter) / sensor.rate * 1e9) * 1e-9;
  stamp_error_ = sensor.stamp_noise * noise_();
  if (sensor.stamps_late) stamp_error_ = std::abs(stamp_error_);
  speed_error_ = sensor.speed_noise * noise_();
}

CrankTruth SessionStream::truth() const {
  return std::visit([](const auto& machine) { return CrankTruth(machine.truth()); }, machine_);
}

void SessionStream::advanceMachine(double time) {
  std::visit([time](auto& machine) { machine.advanceTo(time); }, machine_);
}

/// Reads the encoder as the controller does, up to `time`.
void SessionStream::readTask(double time) {
  const double period = settings_.crank.task_period;
  for (double next; period > 0.0 && (next = static_cast<double>(tasks_) * period) <= time; ++tasks_) {
    advanceMachine(next);
    task_.push_back(encoded(settings_.crank, truth()));
    if (task_.size() > static_cast<std::size_t>(settings_.crank.task_mean)) task_.pop_front();
  }
}

void SessionStream::moveTo(double time) {
  readTask(time);
  while ((angle_.isOn() || speed_.isOn() || hoses_[0].isOn()) && sensor_time_ < time) {
    sensor_time_ = std::min(time, sensor_time_ + kSensorStep);
    advanceMachine(sensor_time_);
    if (angle_.isOn() || speed_.isOn()) {
      const EncoderReading now = encoded(settings_.crank, truth());
      angle_.follow(sensor_time_, now.angle);
      speed_.follow(sensor_time_, now.speed);
    }
    if (!hoses_[0].isOn()) continue;
    const OnBoomSensors felt = std::get<HammerOnBoom>(machine_).sensors();
    for (std::size_t k = 0; k < 3; ++k) {
      hoses_[k].follow(sensor_time_, felt.bore_pressure[k]);
      hoses_[k + 3].follow(sensor_time_, felt.rod_pressure[k]);
    }
  }
  advanceMachine(time);
}

void SessionStream::advanceTo(double time, Session& session) {
  for (;;) {
    const double joints = joints_.next(), imu = imu_.next(), pressures = pressures_.next();
    const double due = std::min({joints, imu, pressures, next_sample_});
    if (due > time) break;
    if (due == joints) {
      session.joints.push_back(readJoints(due));
      ++joints_.count;
    } else if (due == imu) {
      session.imu.push_back(readImu(due));
      ++imu_.count;
    } else if (due == pressures) {
      session.pressures.push_back(readPressures(due));
      ++pressures_.count;
    } else {
      takeCrank(session);
    }
  }
  moveTo(time);
  const auto blows = std::visit([](auto& machine) { return machine.takeBlows(); }, machine_);
  session.blows.insert(session.blows.end(), blows.begin(), blows.end());
}

void SessionStream::takeCrank(Session& session) {
  const auto& lost = settings_.crank.drop_outs;
  const bool lost_one = loss_draws_.uniform() < settings_.crank.loss_share;
  const bool dropped =
      lost_one || std::any_of(lost.begin(), lost.end(), [&](const CrankSensorSettings::Interval& interval) {
        return next_sample_ >= interval.from && next_sample_ < interval.to;
      });
  if (!dropped) {
    moveTo(next_sample_);
    take(session);
  }
  planSample();
}

/// Takes a sample. A burst arrives as a whole, with the stamp of its last sample.
void SessionStream::take(Session& session) {
  const CrankSensorSettings& sensor = settings_.crank;
  Taken taken;
  if (const HammerOnBoom* machine = std::get_if<HammerOnBoom>(&machine_)) {
    taken.on_boom = machine->truth();
    taken.truth = *taken.on_boom;
  } else {
    taken.truth = truth();
  }
  taken.reading = read(taken.truth);
  taken.twice = message_draws_.uniform() < sensor.duplicate_share;
  burst_.push_back(taken);
  if (static_cast<int>(burst_.size()) < sensor.burst) return;
  for (Taken& sample : burst_) {
    sample.reading.stamp = burst_.back().reading.stamp;
    for (int i = 0; i < 1 + sample.twice; ++i) {
      session.crank.push_back(sample.reading);
      session.truth.push_back(sample.truth);
      session.taken.push_back(sample.truth.time);
      if (sample.on_boom) session.on_boom.push_back(*sample.on_boom);
    }
  }
  burst_.clear();
}

/// Returns angle and speed of the sensor before counting. A controller's mean replaces any low-pass.
EncoderReading SessionStream::shown(const CrankTruth& truth) noexcept {
  const CrankSensorSettings& sensor = settings_.crank;
  EncoderReading shown = encoded(sensor, truth);
  if (angle_.isOn()) shown.angle = angle_.output();
  if (!task_.empty()) {
    shown = {};
    for (const EncoderReading& one : task_) shown.angle += one.angle, shown.speed += one.speed;
    const auto readings = static_cast<double>(task_.size());
    shown.angle /= readings, shown.speed /= readings;
  }
  if (sensor.hysteresis > 0.0) {
    const double half = 0.5 * sensor.hysteresis;
    held_ = std::clamp(held_.value_or(shown.angle), shown.angle - half, shown.angle + half);
    shown.angle = *held_;
  }
  return shown;
}

CrankReading SessionStream::read(const CrankTruth& truth) noexcept {
  const CrankSensorSettings& sensor = settings_.crank;
  CrankReading reading;
  const double driver = sensor.driver.areExact() ? 0.0 : sensor.driver.lateness(truth.time, driver_draws_);
  reading.stamp = stampAt(truth.time + sensor.latency + driver + stamp_error_);
  if (sensor.stamp_step > 0.0) {
    const auto step = static_cast<std::int64_t>(std::llround(sensor.stamp_step * 1e9));
    reading.stamp -= reading.stamp % step;
  }
  if (sensor.stamps_ordered) reading.stamp = std::max(reading.stamp, last_stamp_ + 1);
  last_stamp_ = reading.stamp;
  const std::int64_t turn = sensor.unwound ? truth.turn : 0;
  double speed = truth.speed;
  if (!isPlain(sensor) || truth.twist != 0.0) {
    const EncoderReading shown = this->shown(truth);
    const bool slipped = truth.time >= sensor.slip.during.from && truth.time < sensor.slip.during.to;
    const double angle = shown.angle + (slipped ? sensor.slip.amount : 0.0);
    const double count = kTwoPi / std::max(sensor.counts, 1);
    const double seen = sensor.counts > 0 ? std::floor(angle / count) * count : angle;
    reading.angle = sensor.unwound ? seen : seen - kTwoPi * std::floor((seen + 1e-9) / kTwoPi);
    speed = shown.speed;
  } else if (sensor.counts > 0) {
    const double count = kTwoPi / sensor.counts;
    // The last count of a revolution is the encoder's last, however close the angle is to 2 pi.
    const std::int64_t passed =
        std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(truth.angle / count)), sensor.counts - 1);
    reading.angle = static_cast<double>(turn * sensor.counts + passed) * count;
  } else {
    reading.angle = static_cast<double>(turn) * kTwoPi + truth.angle;
  }
  if (speed_.isOn()) speed = speed_.output();
  if (sensor.speed) reading.speed = sensor.speed_scale * speed + speed_error_;
  return reading;
}

std::int64_t SessionStream::stampAt(double time) const noexcept {
  return settings_.start_stamp + static_cast<std::int64_t>(std::llround(time * 1e9));
}

/// Visits the instants in chronological order.
std::vector<CrankTruth> truthAt(const MachineSettings& settings, const std::vector<double>& times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  std::vector<CrankTruth> truth(times.size());
  auto any = machineOf(settings);
  const auto visit = [&](auto& machine) {
    for (const std::size_t i : order) {
      machine.advanceTo(times[i]);
      truth[i] = machine.truth();
    }
  };
  std::visit(visit, any);
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
