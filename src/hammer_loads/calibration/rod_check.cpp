#include "hammer_loads/calibration/rod_check.h"

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/linkage/blow_inertia.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

/// Largest effect of rods of 2e8 to 1e10 N/m with joint clearance up to 0.5 mm on the zero, the eccentricity and the
/// drive's inertia (relative).
constexpr double kOfZero = 3.0 * kDegree, kOfEccentricity = 1.5 * kDegree, kOfInertia = 0.3;

CrankSensor sensorOf(const Globals& globals) {
  CrankSensorPlace place;
  place.zero = globals[kZero];
  for (const Eigen::Index n : {0, 1}) {
    const Eigen::Vector2d parts = globals.segment<2>(kSine1 + 2 * n);
    place.eccentricity[n] = parts.norm();
    place.eccentricity_phase[n] = std::atan2(parts[1], parts[0]);
  }
  return CrankSensor::make(place).value.value_or(CrankSensor());
}

CrankFilterSettings settingsOf(const CrankTrack& track, const CalibrationBasis& basis, const JointFit& fit) {
  CrankFilterSettings s = basis.filter;
  s.sensor = sensorOf(fit.globals);
  s.angle_resolution = 0.0;
  s.zero_std = ConstantErrors::kUnknownZero;
  s.angle_noise = track.facts.count > 0.0 ? 0.0 : fit.noise.angle;
  s.timing_noise = fit.noise.timing;
  s.speed_noise = std::max(fit.noise.speed, basis.filter.speed_noise);
  s.blow_factor = blowInertia(basis.mechanism, rigid(basis.level), std::exp(fit.globals[kLogInertia])).smoothFactor();
  return s;
}

}  // namespace

RodEvidence rodEvidence(const CrankTrack& track, const CalibrationBasis& basis, const JointFit& fit) {
  const ShaftModel model(basis.mechanism, basis.level);
  CrankFilter filter(model, std::exp(fit.globals[kLogInertia]), settingsOf(track, basis, fit));
  std::size_t piece = 0;
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    const CrankPoint& point = track.points[i];
    HullMotion hull;
    hull.gravity = point.gravity;
    filter.setHullMotion(hull);
    if (piece < track.starts.size() && track.starts[piece] == i) {
      filter.start({point.seen, point.speed});
      ++piece;
    } else if (point.time > track.points[i - 1].time) {
      filter.update(point.time - track.points[i - 1].time, {point.seen, point.speed});
    }
  }
  return filter.rodEvidence();
}

void refuseForRod(const RodEvidence& rod, double ratio, Calibration& result) {
  result.rod_gives = rod.gives();
  if (!rod.gives()) return;
  const auto doubt = [&](const char* key, double by) {
    for (Estimate& e : result.estimates)
      if (e.key == key) e.deviation = std::hypot(e.deviation, by);
  };
  for (Estimate& e : result.estimates) {
    if (e.key == "crank_zero_rad") e.deviation = std::hypot(e.deviation, kOfZero * std::abs(ratio));
    if (e.key == "drive_inertia_kg_m2") e.deviation = std::hypot(e.deviation, kOfInertia * e.value);
  }
  for (const char* n : {"1", "2"}) {
    doubt((std::string("crank_eccentricity_") + n + "_rad").c_str(), kOfEccentricity);
    doubt((std::string("crank_eccentricity_") + n + "_phase_rad").c_str(), kTwoPi);
  }
  result.remarks.push_back(whatARodDoes(rod, true));
}

std::string whereReadingsDiffer(const RodEvidence& rod) {
  return format(
      "just after the blow readings differ from a rigid rod's by %.2g times the expected variance, a quarter of a "
      "revolution later by %.2g",
      rod.pickedUp(), rod.later());
}

std::string whatARodDoes(const RodEvidence& rod, bool settled) {
  return whereReadingsDiffer(rod) + ": " + (settled ? "" : "lengths or masses of the hammer file are others, or ") +
         "rod, pins and bearings give. A rigid rod's fit takes that for a zero up to 3 deg too small and for an "
         "eccentric encoder, so neither is written. Turn the crank by hand, or let it creep without blows, to "
         "where the rocker rests on its tool and crank and rod are in line: the reading there is crank_zero_rad. "
         "With it level: elastic learns rod and drive at work";
}

}  // namespace hammer_loads::calibration
