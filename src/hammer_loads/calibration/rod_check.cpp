#include "hammer_loads/calibration/rod_check.h"

#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/linkage/blow_inertia.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads::calibration {
namespace {

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
  double before = 0.0;
  for (const CrankPoint& point : track.points) {
    HullMotion hull;
    hull.gravity = point.gravity;
    filter.setHullMotion(hull);
    if (point.starts) {
      filter.start({point.seen, point.speed});
    } else if (point.time > before) {
      filter.update(point.time - before, {point.seen, point.speed});
    }
    before = point.time;
  }
  return filter.rodEvidence();
}

std::string textOf(const RodEvidence& rod, bool settled) {
  const std::string where = format(
      "just after the blow readings differ from a rigid rod's by %.2g times the expected variance, a quarter of a "
      "revolution later by %.2g",
      rod.pickedUp(), rod.later());
  if (!rod.showsElasticRod()) return where;
  return where + ": " + (settled ? "" : "lengths or masses of the hammer file are others, or ") +
         "rod, pins and bearings give. A rigid rod's fit takes that for a zero up to 3 deg too small and for an "
         "eccentric encoder, so neither is written. Turn the crank by hand, or let it creep without blows, to "
         "where the rocker rests on its tool and crank and rod are in line: the reading there is crank_zero_rad. "
         "With it level: elastic learns rod and drive at work";
}

}  // namespace hammer_loads::calibration
