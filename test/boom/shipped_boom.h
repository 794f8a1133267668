/// The shipped boom on its cylinders' oil, in its working position.
#pragma once

#include <gtest/gtest.h>

#include "boom/booms.h"

namespace hammer_loads::test {

class ShippedBoom : public testing::Test {
 protected:
  ShippedBoom() : boom_(shippedBoom()) { pose(workingPosition()); }
  void pose(const JointVector& q) { boom_.moveCompliant({q, kZero, kZero}, Eigen::Vector3d::Zero()); }
  Vibration& vibration() { return boom_.vibration(); }
  const BoomModes& modes() { return boom_.vibration().modes(); }
  void steadyLoad(double step, const JointVector& torque) { vibration().advance(step, {torque, torque, torque}); }

  Boom boom_;
  const Wrench push_{Eigen::Vector3d(2e3, 0.0, 8e3), Eigen::Vector3d(0.0, -500.0, 0.0)};
};

}  // namespace hammer_loads::test
