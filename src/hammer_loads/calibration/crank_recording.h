/// A recording of the crank's sensor, and its division into segments around the blows.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hammer_loads/linkage/link_motion.h"

namespace hammer_loads::calibration {

/// One message on the crank's topic, in the order of arrival.
struct RecordedSample {
  double time{};                ///< header stamp from an arbitrary instant [s]
  double reading{};             ///< any number of revolutions [rad]
  std::optional<double> speed;  ///< measured speed [rad/s]
  Gravity gravity;              ///< in hull axes [m/s2]
};

/// Properties of the readings and stamps.
struct SensorFacts {
  double count{};    ///< largest whole fraction of a revolution that divides all readings [rad]; 0: none
  double period{};   ///< median step of the stamps [s]
  bool retimed{};    ///< stamps repeat or are out of order and are replaced by equal intervals
  int direction{1};  ///< -1: readings decrease while the crank goes forward
};

/// Sample of the encoder, with an angle that increases while the hammer works.
struct CrankPoint {
  double time{};                ///< [s]
  double seen{};                ///< reading at mid-count, unwrapped and divided by direction and ratio [rad]
  std::optional<double> speed;  ///< measured speed [rad/s]
  Gravity gravity;
  bool starts{};  ///< the first one, or the first one after a gap; unwrapping restarts there
};

struct CrankTrack {
  std::vector<CrankPoint> points;
  SensorFacts facts;
};

/// Puts the times in order and unwraps the readings. ratio: encoder revolutions per crank revolution [-].
CrankTrack trackOf(const std::vector<RecordedSample>& recorded, double ratio);

/// Forward motion of the crank from the middle of one revolution, over the blow, to the middle of the next.
struct BlowSegment {
  std::vector<CrankPoint> points;  ///< `seen` minus whole revolutions: near `zero` at the blow
  Gravity gravity;                 ///< mean
};

/// Cuts the track into segments around the blows. zero: first guess of the blow's position in `seen` [rad].
std::vector<BlowSegment> cutAtBlows(const CrankTrack& track, double zero);

}  // namespace hammer_loads::calibration
