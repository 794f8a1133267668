/// Every topic that the grapple's motion is published on.
#pragma once

#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hammer_loads/RunInfo.h>
#include <sensor_msgs/JointState.h>

#include <string>

#include "hammer_loads/ros/output.h"

namespace hammer_loads {

/// Outputs of the jaw edge P.
struct JawOutputs {
  /// jaw: left or right.
  explicit JawOutputs(const std::string& jaw)
      : edge("jaw_edge/" + jaw, LoggedOutputs::kWrench),
        twist("jaw_edge/" + jaw + "_twist", LoggedOutputs::kWrench),
        accel("jaw_edge/" + jaw + "_accel", LoggedOutputs::kWrench) {}

  Output<geometry_msgs::PointStamped> edge;   ///< P [m]
  Output<geometry_msgs::TwistStamped> twist;  ///< velocity of P [m/s], turning speed of the jaw about z [rad/s]
  Output<geometry_msgs::AccelStamped> accel;  ///< acceleration of P [m/s2], turning acceleration about z [rad/s2]
};

struct GrappleOutputs {
  Output<RunInfo> run_info{"run_info", LoggedOutputs::kNone, Delivery::kLatched};
  JawOutputs left{"left"}, right{"right"};
  /// Joints of scripts/grapple_urdf [m, rad] with their speeds if the slider's is known.
  Output<sensor_msgs::JointState> mechanism{"mechanism"};

  template <typename Visit>
  void forEach(const Visit& visit) {
    visit(run_info);
    for (JawOutputs* jaw : {&left, &right}) visit(jaw->edge), visit(jaw->twist), visit(jaw->accel);
    visit(mechanism);
  }
};

}  // namespace hammer_loads
