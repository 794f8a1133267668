#include "hammer_loads/pipeline/measured_torques.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kShare = 0.005;       // of one reading in the mean of squares: some 200 count
constexpr double kLongestLine = 0.02;  // beyond a reading [s]

}  // namespace

/// oil: of the vibration at the reading, after it was taken and as it was said before.
void MeasuredTorques::take(Track& track, StampNs stamp, double torque, double oil, double oil_before) noexcept {
  const double step = seconds(stamp - track.stamp);
  if (track.readings > 0 && step > 0.0) {
    const double change = torque - track.torque;
    track.oil_square += kShare * (square(change - (oil_before - track.oil)) - track.oil_square);
    track.line_square += kShare * (square(change - step * track.slope) - track.line_square);
    track.slope = change / step;
  }
  track.stamp = stamp, track.torque = torque, track.oil = oil;
}

void MeasuredTorques::follow(const Boom& boom, const JointVector& position, const JointVector& steady, StampNs sample,
                             const CylinderPressures& pressures) noexcept {
  const Vibration::OilTorque oil = boom.vibration().oilTorque();
  if (oil_.now.size() != oil.now.size()) oil_ = oil, sample_ = sample;
  for (std::size_t i = 0; i < boom.cylinders().size(); ++i) {
    const Cylinder& cylinder = boom.cylinders()[i];
    const int j = cylinder.joint();
    const CylinderPosition at = cylinder.at(position[j]);  // of a measured force the lever as it is measured
    Track& track = tracks_[i];
    torque_[i].reset();
    const StampNs stamp = pressures.newest(i);
    const std::optional<ChamberPressures> read = pressures.at(i, stamp);
    if (!read || !pressures.known(i, sample) || at.dead_centre) {
      track = {};
      continue;
    }
    if (pressures.count(i) != track.readings) {
      const double before = oil_.now[j] + seconds(stamp - sample_) * oil_.rate[j];
      const double now = oil.now[j] + seconds(stamp - sample) * oil.rate[j];
      take(track, stamp, -forceOf(cylinder, *read) * at.arm - steady[j], now, before);
      track.readings = pressures.count(i);
    }
    const double age = std::min(seconds(sample - stamp), kLongestLine);
    const bool by_oil = track.oil_square <= track.line_square;
    const double change = by_oil ? oil.now[j] - track.oil : age * track.slope;
    const double off = std::sqrt(by_oil ? track.oil_square : track.line_square);
    torque_[i] = Torque{steady[j] + track.torque + change, off, at};
  }
  oil_ = oil, sample_ = sample;
}

}  // namespace hammer_loads
