/// Publisher of diagnostic_updater's tasks on /diagnostics and in the log, without its arithmetic on ROS time.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <chrono>
#include <string>

#include "hammer_loads/log/bag_log.h"

namespace hammer_loads {

/// Replaces diagnostic_updater::Updater, which adds its period to the time now. The sum throws within the last second
/// before 2^32 s, in the constructor as well, and a /clock may have any value.
class DiagnosticsPublisher : public diagnostic_updater::DiagnosticTaskVector {
 public:
  /// clock: of the node's inputs; a logged report has the record time of the last one. Both must outlive this.
  DiagnosticsPublisher(ros::NodeHandle node, const ros::NodeHandle& private_node, BagLog& log, const RecordClock& clock)
      : log_(log),
        clock_(clock),
        publisher_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1)),
        period_(private_node.param("diagnostic_period", 1.0)),
        // The name space is the node's own, a nodelet's in a manager as well.
        name_(private_node.getNamespace().substr(1)) {}

  double period() const { return period_; }  ///< wall time between two reports [s]

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

 private:
  BagLog& log_;
  const RecordClock& clock_;
  ros::Publisher publisher_;
  double period_;
  std::string name_;
};

/// [s]
inline double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace hammer_loads
