/// Publisher of diagnostic_updater's tasks on /diagnostics and in the log, without arithmetic on ROS time.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>
#include <functional>
#include <string>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// Publisher with the period `~diagnostic_period` (1 s) in wall time, because it must also report a stopped /clock. It
/// replaces diagnostic_updater::Updater, which adds its period to the current time. The sum throws within the last
/// second before 2^32 s, also in the constructor, and a /clock may have any value.
class DiagnosticsPublisher : public diagnostic_updater::DiagnosticTaskVector {
 public:
  /// clock: of the node's inputs; a logged report has the record time of the last input. log and clock must outlive
  /// this. before: called before each report.
  DiagnosticsPublisher(ros::NodeHandle node, const ros::NodeHandle& private_node, BagLog& log, const RecordClock& clock,
                       const std::function<void()>& before)
      : log_(log),
        clock_(clock),
        publisher_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)),
        // The namespace is the node's own, also for a nodelet in a manager.
        name_(private_node.getNamespace().substr(1)),
        timer_(node.createWallTimer(ros::WallDuration(private_node.param("diagnostic_period", 1.0)),
                                    [this, before](const ros::WallTimerEvent&) {
                                      before();
                                      publish();
                                    })) {}

 private:
  void publish() {
    diagnostic_msgs::DiagnosticArray message;
    for (const DiagnosticTaskInternal& task : getTasks()) {
      diagnostic_updater::DiagnosticStatusWrapper status;
      task.run(status);
      status.name = name_ + ": " + task.getName();
      status.hardware_id = "none";
      message.status.push_back(status);
    }
    message.header.stamp = ros::Time::now();
    publisher_.publish(message);
    if (log_.logs(LoggedOutputs::kPerTurn) && !clock_.last().isZero())
      log_.write(publisher_.getTopic(), clock_.last(), message);
  }

  BagLog& log_;
  const RecordClock& clock_;
  ros::Publisher publisher_;
  std::string name_;
  ros::WallTimer timer_;
};

/// Returns the time between two instants [s].
inline double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace hammer_loads
