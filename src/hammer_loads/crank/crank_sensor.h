/// Mounting of the crank's encoder: conversion of its readings to the crank's angle and speed.
#pragma once

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Keys `crank_*` of the same names with the unit appended.
struct CrankSensorPlace {
  double zero{};                   ///< reading at the blow [rad]
  int direction{1};                ///< 1, or -1 for an encoder that counts against the crank's turn
  double ratio{1.0};               ///< encoder turns per crank turn [-], > 0
  double eccentricity[2]{};        ///< once and twice a turn [rad], >= 0
  double eccentricity_phase[2]{};  ///< [rad]
};

/// reading = zero + direction ratio (angle + sum a_n [sin(n angle + phase_n) - sin(phase_n)]), n = 1, 2: an encoder
/// that sits off its centre by a part a_1 of its radius, or on an oval one. Its terms vanish at the blow, so that the
/// zero alone shows where that is. A measured speed is the reading's derivative.
///
/// An encoder that is geared to the crank must count its turns on (readings not wrapped), unless its turn is a whole
/// number of the crank's.
class CrankSensor {
 public:
  /// The reading is the angle, to the last bit.
  CrankSensor() = default;
  /// Refuses a direction other than 1 and -1, a ratio of 0, eccentricity with a ratio other than 1, and eccentricity by
  /// which the reading might turn back: a_1 + 2 a_2 >= 1.
  static Checked<CrankSensor> make(const CrankSensorPlace& place);

  /// Crank angle [rad], in the winding of the reading [rad].
  double angle(double reading) const noexcept;
  /// Crank speed [rad/s] from a measured one at a crank angle [rad].
  double speed(double angle, double measured) const noexcept;
  /// Crank angle per reading, its mean over the turn [-].
  double gain() const noexcept { return gain_; }
  const CrankSensorPlace& place() const noexcept { return place_; }
  bool isIdentity() const noexcept { return identity_; }
  /// Reading [rad] at a crank angle [rad].
  double reading(double angle) const noexcept;
  /// Moves the mounting: readings are larger by that angle of the crank [rad] from now on.
  void slip(double angle) noexcept {
    place_.zero += angle / gain_;
    identity_ = false;
  }

 private:
  double excess(double angle) const noexcept;
  double slope(double angle) const noexcept;

  CrankSensorPlace place_;
  double offset_[2]{};  ///< a_n sin(phase_n) [rad]
  double gain_{1.0};    ///< direction/ratio
  bool identity_{true};
  bool centred_{true};
};

}  // namespace hammer_loads
