/// A recording of the crank's sensor, and its division into segments around the blows.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hammer_loads/linkage/link_motion.h"

namespace hammer_loads::calibration {

/// One message on the crank's topic, in the order of arrival.
struct RecordedSample {
  double time{};                ///< header stamp since any instant [s]
  double reading{};             ///< any winding [rad]
  std::optional<double> speed;  ///< measured speed [rad/s]
  Gravity gravity;              ///< in hull axes [m/s2]
};

/// Properties of the readings and stamps.
struct SensorFacts {
  double count{};    ///< largest whole part of a turn that all readings are multiples of [rad]; 0: none
  double period{};   ///< median of the stamps' steps [s]
  bool retimed{};    ///< stamps repeated or changed places: taken at equal intervals instead
  int direction{1};  ///< -1: the readings fall as the crank goes forward
};

/// A sample in the encoder's own turn, which grows while the hammer works.
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

/// Time in order, readings unwrapped. ratio: encoder turns per crank turn [-].
CrankTrack trackOf(const std::vector<RecordedSample>& recorded, double ratio);

/// From the middle of a turn over its blow to the middle of the next: where the crank went forward all the way.
struct BlowSegment {
  std::vector<CrankPoint> points;  ///< `seen` less the whole turns: near `zero` at the blow
  Gravity gravity;                 ///< mean
};

/// zero: where the blow is by first guess, in `seen` [rad].
std::vector<BlowSegment> cutAtBlows(const CrankTrack& track, double zero);

}  // namespace hammer_loads::calibration
