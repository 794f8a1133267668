/// Plays sessions of a machine whose hull hangs on its boom into a pipeline and compares them with their truth. The
/// pose is unseen, the boom moves, each sensor has its own rate, and joint sensors measure the vibration.
#pragma once

#include <gtest/gtest.h>

#include <array>

#include "hammer_loads/bench/boom_errors.h"
#include "support/exact_hammer.h"
#include "support/session_player.h"

namespace hammer_loads::test {

constexpr double kJudgedFrom = 6.0, kJudgedTo = 10.0;  ///< [s]: the machine works from 2 s on

/// Joints of boom, arm and hammer [rad].
using Pose = std::array<double, 3>;
constexpr Pose kUsualPose{-0.45, 1.00, -0.50};

/// Draws a pose within the reach of all three cylinders, the hull near upright. between(low, high): random number.
template <typename Between>
Pose drawnPose(const Between& between) {
  const double boom = between(-0.8, -0.1), arm = between(0.7, 1.7), lean = between(-0.3, 0.3);
  return {boom, arm, lean - boom - arm};
}

inline simulation::MachineSettings machineOnBoom(double oil, double joint_rate, const Pose& pose = kUsualPose) {
  simulation::MachineSettings m = accuracy::machineOnBoom(kJudgedTo);
  m.seed = 41;
  for (std::size_t k = 0; k < 3; ++k) m.boom[k + 1].mean = pose[k];
  m.joint_rate = joint_rate;
  m.on_boom.oil_stiffness = oil;
  return m;
}

/// Returns the errors of a session with the shipped boom file and the keys in `parameters`.
inline accuracy::BoomErrors errorsOf(const std::string& name, const simulation::Session& session,
                                     const std::string& parameters, const accuracy::SensorsOnBoom& sensors) {
  const Settings settings = withExactHammer(settingsWith("boom: compliant\n" + parameters));
  const accuracy::BoomErrors e = accuracy::boomErrors(session, settings, sensors, kJudgedFrom, kJudgedTo);
  EXPECT_EQ(e.refused, 0U) << name;
  EXPECT_GT(e.blows, 15U) << name;
  return e;
}

}  // namespace hammer_loads::test
