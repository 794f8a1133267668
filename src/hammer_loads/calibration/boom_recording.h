/// A recording of the boom's free movement, and the instants that it is fitted at.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "hammer_loads/boom/joint_space.h"

namespace hammer_loads::calibration {

/// Readings of one sensor in the order of their stamps.
struct Trace {
  std::vector<double> time;  ///< header stamp since any instant, the same of all traces [s]
  std::vector<double> value;
};

struct BoomRecording {
  std::vector<Trace> joint;                    ///< one per joint of the chain [rad]; empty: at zero, never heard
  std::vector<std::array<Trace, 2>> pressure;  ///< one per cylinder: bore, rod; gauge [Pa]
  std::vector<double> working;                 ///< times at which the hammer's crank turned [s]
};

/// Adds what goes on `later` seconds after the first one began: the next split of one recording.
void append(const BoomRecording& next, double later, BoomRecording& recording);

/// Time of the last reading [s].
double endOf(const BoomRecording& recording);

/// All sensors at one instant, from a parabola in time through the readings around it: joints and pressures
/// are smoothed alike, so that the one fits the other.
struct BoomPoint {
  double time{};                                             ///< [s]
  JointMotion motion;                                        ///< motion of the joints as read
  JointVector rate_std;                                      ///< standard, of motion.velocity [rad/s]
  std::array<std::array<double, 2>, kMaxJoints> pressure{};  ///< per cylinder: bore, rod [Pa]
  double half_width{};                                       ///< half the duration of the readings around it [s]
};

struct BoomPoints {
  std::vector<BoomPoint> points;
  std::size_t left_out{};  ///< instants with a gap in some trace, or while the hammer worked
  double seconds{};        ///< from the first instant that all sensors know to the last
};

/// At equal intervals; neighbours share half of their readings.
BoomPoints pointsOf(const BoomRecording& recording);

}  // namespace hammer_loads::calibration
