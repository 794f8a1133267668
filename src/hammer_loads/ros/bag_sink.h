/// Writes the hammer's outputs to a bag.
#pragma once

#include <rosbag/bag.h>

#include <cstdint>
#include <string>

#include "hammer_loads/ros/bag_output.h"
#include "hammer_loads/ros/loads_flow.h"

namespace hammer_loads {

class BagSink final : public LoadsSink {
 public:
  /// prefix: of every topic, without / at its end; pins: pin forces as well.
  BagSink(rosbag::Bag& bag, const std::string& prefix, bool pins) : bag_(bag), prefix_(prefix + "/"), pins_(pins) {}

  void runInfo(const RunInfo& message, const ros::Time& record_time) override {
    writeLatched(bag_, prefix_ + "run_info", record_time, message);
  }
  void hullWrench(const geometry_msgs::WrenchStamped& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "hull_wrench", record_time, message);
    ++wrenches_;
  }
  void boomWrench(const std::string& link, const geometry_msgs::WrenchStamped& message,
                  const ros::Time& record_time) override {
    bag_.write(prefix_ + "boom_wrench/" + link, record_time, message);
  }
  void jointLoads(const JointLoads& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "joint_loads", record_time, message);
  }
  void boomVibration(const BoomVibration& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "boom_vibration", record_time, message);
  }
  void hullLoads(const HullLoads& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "hull_loads", record_time, message);
  }
  void mechanism(const sensor_msgs::JointState& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "mechanism", record_time, message);
  }
  void pinForces(const PinForces& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "pin_forces", record_time, message);
  }
  void blow(const Blow& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "blow", record_time, message);
    ++turns_;
  }
  void pulse(const Pulse& message, const ros::Time& record_time) override {
    bag_.write(prefix_ + "pulse", record_time, message);
  }
  bool wantsBoomWrench(const std::string&) const override { return true; }
  bool wantsJointLoads() const override { return true; }
  bool wantsBoomVibration() const override { return true; }
  bool wantsHullLoads() const override { return true; }
  bool wantsMechanism() const override { return true; }
  bool wantsPinForces() const override { return pins_; }
  bool wantsTurns() const override { return true; }

  std::uint64_t wrenches() const { return wrenches_; }  ///< hull wrenches written
  std::uint64_t turns() const { return turns_; }        ///< blows written

 private:
  rosbag::Bag& bag_;
  std::string prefix_;
  bool pins_;
  std::uint64_t wrenches_{}, turns_{};
};

}  // namespace hammer_loads
