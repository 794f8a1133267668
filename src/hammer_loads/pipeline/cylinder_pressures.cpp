#include "hammer_loads/pipeline/cylinder_pressures.h"

#include <algorithm>
#include <cmath>

namespace hammer_loads {
namespace {

constexpr double kMostPressure = 2e8;  // [Pa]: 2000 bar
// Limit: kMostPressure

}  // namespace

bool CylinderPressures::update(StampNs stamp, std::size_t cylinder, Chamber chamber, double pressure) noexcept {
  Track& track = tracks_[cylinder][static_cast<std::size_t>(chamber)];
  const bool late = track.readings > 0 && stamp <= track.now.stamp;
  const bool again = late && track.rewound && stamp > *track.rewound;
  if (late) track.rewound = stamp;
  if (!(std::abs(pressure) <= kMostPressure) || (late && !again)) {
    ++refused_;
    return false;
  }
  track.rewound.reset();
  const bool goes_on = !late && track.readings > 0 && seconds(stamp - track.now.stamp) <= max_age_;
  if (goes_on && !track.guard.accepts(std::abs(pressure - track.now.pressure))) {
    ++refused_;
    return false;
  }
  track.before = track.now;
  track.now = {stamp, pressure};
  track.readings = goes_on ? 2 : 1;
  greatest_ = std::max(greatest_, std::abs(pressure));
  ++accepted_;
  ++counts_[cylinder];
  return true;
}

std::optional<double> CylinderPressures::at(const Track& track, StampNs stamp) const noexcept {
  if (!known(track, stamp)) return std::nullopt;
  if (track.readings == 1 || stamp == track.now.stamp) return track.now.pressure;
  const double interval = seconds(track.now.stamp - track.before.stamp);
  const double part = std::clamp(seconds(stamp - track.now.stamp) / interval, -1.0, 1.0);
  return track.now.pressure + part * (track.now.pressure - track.before.pressure);
}

std::optional<ChamberPressures> CylinderPressures::at(std::size_t cylinder, StampNs stamp) const noexcept {
  const auto bore = at(tracks_[cylinder][0], stamp), rod = at(tracks_[cylinder][1], stamp);
  if (!bore || !rod) return std::nullopt;
  return ChamberPressures{*bore, *rod};
}

}  // namespace hammer_loads
