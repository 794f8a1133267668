/// Slider samples for the tests and a sink that keeps the output of a GrappleFlow.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hammer_loads/grapple_ros/grapple_flow.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline std::string claimsFile() { return configDirectory() + "/grapple_claims.yaml"; }

inline GrappleSettings grappleSettings(SliderAcceleration acceleration = SliderAcceleration::kNone,
                                       const std::string& file = claimsFile()) {
  Checked<GrappleSettings> settings = loadGrappleSettings(configDirectory(), std::vector<std::string>{file});
  for (const std::string& problem : settings.problems) ADD_FAILURE() << problem;
  settings.value.value().acceleration = acceleration;
  return *settings.value;
}

/// Returns the slider among other joints, position [m], velocity [m/s].
inline sensor_msgs::JointState sliderMessage(const ros::Time& stamp, double position, std::optional<double> velocity) {
  sensor_msgs::JointState m;
  m.header.stamp = stamp;
  m.name = {"boom_joint", "grapple_slider_joint", "arm_joint"};
  m.position = {0.1, position, 0.2};
  if (velocity) m.velocity = {kNan, *velocity, 0.0};  // values of other joints do not concern the grapple
  return m;
}

/// A faulty sample and the name under which it is counted.
struct BadSample {
  const char* reason;
  sensor_msgs::JointState message;
};

/// Returns each fault once; the valid samples before have the given stamp and position.
inline std::vector<BadSample> badSamples(const ros::Time& last, double position) {
  const ros::Time next = last + ros::Duration(0.01);
  sensor_msgs::JointState foreign = sliderMessage(next, position, 0.1), no_position = foreign, few_speeds = foreign;
  foreign.name[1] = "wheel";
  no_position.position.resize(1);
  few_speeds.velocity.resize(1);
  return {{"missing joint", foreign},
          {"short array", no_position},
          {"short array", few_speeds},
          {"duplicate", sliderMessage(last, position, 0.1)},
          {"out of order", sliderMessage(last - ros::Duration(0.05), position, 0.1)},
          {"not finite", sliderMessage(next, kNan, 0.1)},
          {"not finite", sliderMessage(next, position, std::numeric_limits<double>::infinity())},
          {"across fold", sliderMessage(next, 0.74, 0.1)},
          {"across fold", sliderMessage(next, 0.88, 0.1)},
          {"out of reach", sliderMessage(next, 0.9, 0.1)},
          {"across dead centre", sliderMessage(next, -2.0, 0.1)},
          {"outside stroke", sliderMessage(next, 0.7, 0.1)}};
}

/// Keeps the output of a GrappleFlow; must outlive it.
struct KeptMessages {
  template <typename Message>
  using Kept = std::vector<std::pair<ros::Time, Message>>;  // with record time

  void attachTo(GrappleOutputs& outputs) {
    keep(outputs.run_info, run_infos), keep(outputs.mechanism, mechanisms);
    std::size_t jaw = 0;
    for (JawOutputs* of : {&outputs.left, &outputs.right}) {
      keep(of->edge, edges[jaw]), keep(of->twist, twists[jaw]), keep(of->accel, accels[jaw]);
      ++jaw;
    }
  }

  Kept<RunInfo> run_infos;
  std::array<Kept<geometry_msgs::PointStamped>, 2> edges;  // left, right
  std::array<Kept<geometry_msgs::TwistStamped>, 2> twists;
  std::array<Kept<geometry_msgs::AccelStamped>, 2> accels;
  Kept<sensor_msgs::JointState> mechanisms;

 private:
  template <typename Message>
  static void keep(Output<Message>& output, Kept<Message>& kept) {
    output.attach([&kept](const Message& message, const ros::Time& time) { kept.emplace_back(time, message); });
  }
};

}  // namespace hammer_loads::test
