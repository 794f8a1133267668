#include "hammer_loads/ros/machine_player.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/init.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hammer_loads/ros/node_diagnostics.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/simulation/session.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

std::ofstream opened(const std::string& path, const char* header) {
  std::ofstream file(path);
  if (!(file << header << '\n')) throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
  return file;
}

/// Returns the stamp with all nanoseconds, which a double cannot hold.
std::string stampText(std::int64_t nanoseconds) {
  constexpr std::int64_t kGiga = 1'000'000'000;
  return format("%lld.%09lld", static_cast<long long>(nanoseconds / kGiga),
                static_cast<long long>(nanoseconds % kGiga));
}

using simulation::CrankReading;
using simulation::JointReading;
using simulation::Session;
using std::chrono::steady_clock;

constexpr auto kBatch = std::chrono::milliseconds(1);
constexpr double kLongestBatch = 5e-3;  // [s] of wall time
constexpr double kMostAhead = 2.0;  // [s] of wall time; a node reports once a second, and its queues hold ten seconds
constexpr auto kPoll = std::chrono::milliseconds(10);
constexpr double kJointPatience = 1.0;  // a subscriber to the crank connects to the joints at about the same time [s]
constexpr double kNotable = 1.0;        // delay that is worth a warning [s]
constexpr auto kLastDelivery = std::chrono::milliseconds(500);  // for subscribers that do not report
constexpr std::uint32_t kQueueSize = 100000;                    // 20 s at 5 kHz: a stalled subscriber loses no message
constexpr std::uint32_t kOwnClockStart = 1700000000;            // [s]; fixed, so that the same seed gives the same bag

double seconds(steady_clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// PREFIX_samples.csv holds the load on the hull at the instants of the crank readings, PREFIX_blows.csv the blows.
/// Stamps are those of the session [s]; a load is that of links and drive about D in axes of hammer_hull [N], [N m].
class TruthFiles {
 public:
  /// Replaces the files. Throws std::runtime_error if one cannot be written.
  explicit TruthFiles(const std::string& prefix)
      : samples_(opened(prefix + "_samples.csv", "stamp_s,force_x_N,force_z_N,torque_y_Nm")),
        blows_(opened(prefix + "_blows.csv",
                      "stamp_s,energy_J,tool_impulse_Ns,rocker_speed_before_rad_s,rocker_speed_after_rad_s")) {}

  /// Appends the true values of a session. start_stamp: stamp of t = 0 [ns].
  void write(const simulation::Session& session, std::int64_t start_stamp) {
    const auto stamp = [start_stamp](double time) { return stampText(start_stamp + std::llround(time * 1e9)); };
    for (const simulation::CrankTruth& truth : session.truth)
      samples_ << stamp(truth.time)
               << format(",%.9g,%.9g,%.9g\n", truth.load.force_x, truth.load.force_z,
                         truth.load.torque_y + truth.drive_reaction_y);
    for (const simulation::BlowTruth& blow : session.blows)
      blows_ << stamp(blow.time)
             << format(",%.9g,%.9g,%.9g,%.9g\n", blow.strike.energy, blow.strike.tool_impulse,
                       blow.strike.rocker_speed_before, blow.strike.rocker_speed_after);
  }

 private:
  std::ofstream samples_, blows_;
};

class MachinePlayer {
 public:
  MachinePlayer(ros::NodeHandle node, const simulation::SimulatorSettings& settings)
      : settings_(settings),
        source_(settings.play.publish_clock ? TimeSource::kOwnClock
                : ros::Time::isSimTime()    ? TimeSource::kClockTopic
                                            : TimeSource::kSteadyClock),
        crank_publisher_(node.advertise<sensor_msgs::JointState>("crank", kQueueSize)),
        joint_publisher_(node.advertise<sensor_msgs::JointState>("joint_states", kQueueSize)) {
    if (source_ != TimeSource::kClockTopic)
      diagnostics_ = node.subscribe("/diagnostics", 100, &MachinePlayer::onDiagnostics, this);
    if (source_ == TimeSource::kOwnClock)
      clock_publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", kQueueSize, true);
    crank_message_.name = {"hammer_crank_joint"};
    crank_message_.position.resize(1);
    crank_message_.velocity.resize(settings_.machine.crank.speed ? 1 : 0);
    joint_message_.name.assign(simulation::kBoomJoints.begin(), simulation::kBoomJoints.end());
    if (settings_.machine.on_boom.on) advertiseHull(node);
  }

  void run() {
    waitForTime();
    waitForSubscribers();
    start();
    const double duration = settings_.machine.duration;
    Session session;
    double last = 0.0;
    for (SteadyTime next = last_step_; ros::ok() && last < duration;
         next = std::max(next + kBatch, steady_clock::now())) {
      std::this_thread::sleep_until(next);
      ros::spinOnce();
      const double time = std::min(timeAfter(last), duration);
      if (time < last) {
        ROS_WARN("time ran back by %.3f s: the machine restarts", last - time);
        start();
        last = 0.0;
        continue;
      }
      publishClock(time);
      session = {};
      stream_->advanceTo(time, session);
      publish(session);
      if (truth_) truth_->write(session, settings_.machine.start_stamp);
      last = time;
    }
    ROS_INFO("%lu crank samples, %lu joint samples, %lu blows in %.3f s", static_cast<unsigned long>(crank_count_),
             static_cast<unsigned long>(joint_count_), static_cast<unsigned long>(blow_count_), last);
    if (left_out_ > kNotable)
      ROS_WARN("the machine took %.1f s longer than in real time: the computer was too busy; nothing is lost",
               left_out_);
    waitForTheLast();
  }

 private:
  enum class TimeSource { kSteadyClock, kClockTopic, kOwnClock };
  using SteadyTime = std::chrono::steady_clock::time_point;

  void advertiseHull(ros::NodeHandle& node) {
    const simulation::OnBoomSettings& sensors = settings_.machine.on_boom;
    if (sensors.imu.rate > 0.0) imu_publisher_ = node.advertise<sensor_msgs::Imu>("hull_imu", kQueueSize);
    imu_message_.header.frame_id = "hammer_hull";
    imu_message_.orientation_covariance[0] = -1.0;  // the IMU measures no orientation
    for (std::size_t i = 0; i < 3; ++i) {
      imu_message_.linear_acceleration_covariance[4 * i] = std::pow(sensors.imu.acceleration_noise, 2);
      imu_message_.angular_velocity_covariance[4 * i] = std::pow(sensors.imu.rate_noise, 2);
    }
    pressure_message_.variance = std::pow(sensors.pressures.noise, 2);
    if (!(sensors.pressures.rate > 0.0)) return;
    const std::string prefix = node.resolveName("cylinder_pressures") + "/";
    for (const std::string cylinder : simulation::kBoomCylinders) {
      for (const char* chamber : {"/bore", "/rod"})
        pressure_publishers_.push_back(
            node.advertise<sensor_msgs::FluidPressure>(prefix + cylinder + chamber, kQueueSize));
    }
  }

  /// Waits until the node has processed the last sample; a receiver that ends with the machine would drop its queues.
  void waitForTheLast() {
    if (followed_ == 0 && ros::ok()) std::this_thread::sleep_for(kLastDelivery);
    while (ros::ok() && followed_ != 0 && followed_ < newest_ && crank_publisher_.getNumSubscribers() > 0) {
      std::this_thread::sleep_for(kPoll);
      ros::spinOnce();
    }
  }

  void waitForSubscribers() {
    const auto wait = [this](const ros::Publisher& publisher, double patience) {
      const SteadyTime begin = steady_clock::now();
      while (ros::ok() && publisher.getNumSubscribers() == 0 && seconds(steady_clock::now() - begin) < patience) {
        publishClock(0.0);  // subscribers may need a valid time to get ready
        std::this_thread::sleep_for(kPoll);
      }
    };
    wait(crank_publisher_, settings_.play.wait_for_subscriber);
    if (crank_publisher_.getNumSubscribers() > 0) wait(joint_publisher_, kJointPatience);
  }

  /// Waits for the first message of an external /clock.
  void waitForTime() {
    while (ros::ok() && source_ == TimeSource::kClockTopic && !ros::Time::isValid()) std::this_thread::sleep_for(kPoll);
  }

  void start() {
    last_step_ = steady_clock::now();
    const ros::Time begin = source_ == TimeSource::kOwnClock ? ros::Time(kOwnClockStart, 0)
                            : source_ == TimeSource::kClockTopic
                                ? ros::Time::now()
                                : timeOf(static_cast<std::int64_t>(ros::WallTime::now().toNSec()));
    settings_.machine.start_stamp = newest_ = stampOf(begin);
    stream_.emplace(settings_.machine);
    if (!settings_.play.truth_prefix.empty()) truth_.emplace(settings_.play.truth_prefix);
  }

  void publishClock(double time) {
    if (source_ != TimeSource::kOwnClock) return;
    rosgraph_msgs::Clock clock;
    clock.clock = ros::Time(kOwnClockStart, 0) + ros::Duration(time);
    clock_publisher_.publish(clock);
  }

  /// Returns the end of the batch after `last`, since the start [s of the machine's time].
  double timeAfter(double last) {
    if (source_ == TimeSource::kClockTopic) return (ros::Time::now() - timeOf(settings_.machine.start_stamp)).toSec();
    const SteadyTime now = steady_clock::now();
    const double passed = seconds(now - std::exchange(last_step_, now));
    const double batch = isFollowed(last) ? std::min(passed, kLongestBatch) : 0.0;
    left_out_ += passed - batch;
    return last + speed() * batch;
  }

  /// Returns false while the node is too far behind. Without a subscriber or a report, the machine never waits.
  bool isFollowed(double last) {
    if (followed_ == 0 || crank_publisher_.getNumSubscribers() == 0) return true;
    const double behind = last - 1e-9 * static_cast<double>(followed_ - settings_.machine.start_stamp);
    if (behind <= speed() * kMostAhead) return true;
    ROS_WARN_ONCE("the machine waits: the node is %.1f s behind, the computer is too busy for it", behind);
    return false;
  }

  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
    for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
      for (const diagnostic_msgs::KeyValue& value : status.values) {
        if (value.key != kLastSampleKey) continue;
        const std::int64_t stamp = std::strtoll(value.value.c_str(), nullptr, 10);
        // A stamp outside this range belongs to another machine.
        if (stamp >= settings_.machine.start_stamp && stamp <= newest_) followed_ = std::max(followed_, stamp);
      }
    }
  }

  /// Publishes each crank sample after the readings that precede it in time.
  void publish(const Session& session) {
    auto joints = session.joints.begin();
    auto imu = session.imu.begin();
    auto pressures = session.pressures.begin();
    const auto publishUntil = [&](std::int64_t stamp) {
      for (; joints != session.joints.end() && joints->stamp <= stamp; ++joints) publishJoints(*joints);
      for (; imu != session.imu.end() && imu->stamp <= stamp; ++imu) publishImu(*imu);
      for (; pressures != session.pressures.end() && pressures->stamp <= stamp; ++pressures)
        publishPressures(*pressures);
    };
    for (const CrankReading& crank : session.crank) {
      publishUntil(crank.stamp);
      publishCrank(crank);
    }
    publishUntil(std::numeric_limits<std::int64_t>::max());
    crank_count_ += session.crank.size();
    joint_count_ += session.joints.size();
    blow_count_ += session.blows.size();
  }

  void publishCrank(const CrankReading& reading) {
    newest_ = std::max(newest_, reading.stamp);
    crank_message_.header.stamp = timeOf(reading.stamp);
    crank_message_.position[0] = reading.angle;
    if (reading.speed) crank_message_.velocity[0] = *reading.speed;
    crank_publisher_.publish(crank_message_);
  }

  void publishJoints(const JointReading& reading) {
    joint_message_.header.stamp = timeOf(reading.stamp);
    joint_message_.position.assign(reading.position.begin(), reading.position.end());
    joint_message_.velocity.assign(reading.velocity.begin(), reading.velocity.end());
    joint_publisher_.publish(joint_message_);
  }

  void publishImu(const simulation::HullImuReading& reading) {
    imu_message_.header.stamp = timeOf(reading.stamp);
    const auto fill = [](geometry_msgs::Vector3& to, const std::array<double, 3>& from) {
      to.x = from[0], to.y = from[1], to.z = from[2];
    };
    fill(imu_message_.linear_acceleration, reading.specific_force);
    fill(imu_message_.angular_velocity, reading.rate);
    imu_publisher_.publish(imu_message_);
  }

  void publishPressures(const simulation::PressureReading& reading) {
    pressure_message_.header.stamp = timeOf(reading.stamp);
    for (std::size_t i = 0; i < pressure_publishers_.size(); ++i) {
      pressure_message_.fluid_pressure = (i % 2 == 0 ? reading.bore : reading.rod)[i / 2];
      pressure_publishers_[i].publish(pressure_message_);
    }
  }
  double speed() const { return source_ == TimeSource::kOwnClock ? settings_.play.clock_factor : 1.0; }

  simulation::SimulatorSettings settings_;
  TimeSource source_;
  ros::Publisher crank_publisher_, joint_publisher_, clock_publisher_, imu_publisher_;
  std::vector<ros::Publisher> pressure_publishers_;  ///< bore and rod of each cylinder in turn
  sensor_msgs::JointState crank_message_, joint_message_;
  sensor_msgs::Imu imu_message_;
  sensor_msgs::FluidPressure pressure_message_;
  std::optional<simulation::SessionStream> stream_;
  std::optional<TruthFiles> truth_;
  SteadyTime last_step_;
  double left_out_{};  ///< wall time that the machine did not follow [s]
  ros::Subscriber diagnostics_;
  std::int64_t newest_{};    ///< stamp of the last crank sample [ns]
  std::int64_t followed_{};  ///< newest stamp that a node has taken; 0: none has reported [ns]
  std::uint64_t crank_count_{}, joint_count_{}, blow_count_{};
};

}  // namespace

void playMachine(ros::NodeHandle node, const simulation::SimulatorSettings& settings) {
  MachinePlayer(std::move(node), settings).run();
}

}  // namespace hammer_loads
