/// A recording of the boom's free movement, and the instants at which it is fitted.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "hammer_loads/boom/joint_space.h"

namespace hammer_loads::calibration {

/// Readings of one sensor in the order of their stamps.
struct Trace {
  std::vector<double> time;  ///< header stamp from an arbitrary instant common to all traces [s]
  std::vector<double> value;
};

struct BoomRecording {
  std::vector<Trace> joint;                    ///< one per joint of the chain [rad]; empty: no readings, joint at zero
  std::vector<std::array<Trace, 2>> pressure;  ///< one per cylinder: bore, rod; gauge [Pa]
  std::vector<double> working;                 ///< times at which the hammer's crank turned [s]
};

/// Appends the next split of a recording, which began `later` seconds after the first one.
void append(const BoomRecording& next, double later, BoomRecording& recording);

/// Returns the time of the last reading [s].
double endOf(const BoomRecording& recording);

/// Values of all sensors at one instant, from a parabola in time through the readings around it. Joints and pressures
/// are smoothed alike, so that they are consistent.
struct BoomPoint {
  double time{};                                             ///< [s]
  JointMotion motion;                                        ///< motion of the joints as read
  JointVector rate_std;                                      ///< standard deviation of motion.velocity [rad/s]
  std::array<std::array<double, 2>, kMaxJoints> pressure{};  ///< per cylinder: bore, rod [Pa]
  double half_width{};                                       ///< half the duration of the readings around it [s]
};

struct BoomPoints {
  std::vector<BoomPoint> points;
  std::size_t left_out{};  ///< instants with a gap in some trace, or while the hammer worked
  double seconds{};        ///< duration during which all sensors have readings [s]
};

/// Returns points at equal intervals; neighbours share half of their readings.
BoomPoints pointsOf(const BoomRecording& recording);

}  // namespace hammer_loads::calibration
