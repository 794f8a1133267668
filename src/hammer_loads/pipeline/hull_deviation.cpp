#include "hammer_loads/pipeline/hull_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hammer_loads {
namespace {

constexpr double kStep[] = {1e-5, 1e-3, 1e-2};  // of angle [rad], speed [rad/s], acceleration [rad/s2]

using Gradient = Eigen::Matrix3d;  // rows: force_x, force_z, torque_y

Eigen::Vector3d vectorOf(const HullWrench& w) noexcept { return {w.force_x, w.force_z, w.torque_y}; }

CrankAngle moved(CrankAngle angle, double by) noexcept {
  angle.offset += by;  // the side stays: the branch's own continuation past the blow
  return angle;
}

/// By central differences; at_angle(links) gives what is wanted by speed and acceleration.
template <typename AtAngle>
Gradient gradient(const CrankEstimate& crank, const LinksBeside& links, const AtAngle& at_angle) noexcept {
  const double speed = crank.speed, acceleration = crank.acceleration;
  const auto [angle_step, speed_step, acceleration_step] = kStep;
  const auto slope = [](const HullWrench& from, const HullWrench& to, double step) {
    return Eigen::Vector3d((vectorOf(to) - vectorOf(from)) * (0.5 / step));
  };
  const auto before = at_angle(links.before), after = at_angle(links.after), here = at_angle(links.here);
  Gradient result;
  result << slope(before(speed, acceleration), after(speed, acceleration), angle_step),
      slope(here(speed - speed_step, acceleration), here(speed + speed_step, acceleration), speed_step),
      slope(here(speed, acceleration - acceleration_step), here(speed, acceleration + acceleration_step),
            acceleration_step);
  return result;
}

HullWrench deviationOf(const Gradient& g, const Eigen::Matrix3d& covariance) noexcept {
  const auto deviation = [&](int row) {
    return std::sqrt(std::max(0.0, g.row(row).dot(covariance * g.row(row).transpose())));
  };
  return {deviation(0), deviation(1), deviation(2)};
}

/// L with L L^T = covariance, also where some variance is zero.
Eigen::Matrix3d root(const Eigen::Matrix3d& covariance) noexcept {
  Eigen::Matrix3d l = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double pivot = covariance(j, j) - l.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0)) continue;
    l(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < 3; ++i) l(i, j) = (covariance(i, j) - l.row(i).head(j).dot(l.row(j).head(j))) / l(j, j);
  }
  return l;
}

}  // namespace

LinksBeside::LinksBeside(const HullModel& model, CrankAngle angle) noexcept
    : before(linksAt(model, moved(angle, -kStep[0]))),
      here(linksAt(model, angle)),
      after(linksAt(model, moved(angle, kStep[0]))) {}

HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                            const LinksBeside& links, const HullMotion& hull,
                            const Eigen::Matrix3d& covariance) noexcept {
  if (!(covariance(1, 1) > 0.0)) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    return {{kUnknown, kUnknown, kUnknown}, kUnknown, kUnknown, kUnknown};
  }
  const Gradient g =
      gradient(crank, links, [&](const LinksAtAngle& at) { return WrenchAtAngle(model, drive, hull, at); });
  return {deviationOf(g, covariance), std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)),
          std::sqrt(covariance(2, 2))};
}

HullWrench momentumDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                             const LinksBeside& links, const Eigen::Matrix3d& covariance) noexcept {
  const Gradient g = gradient(crank, links, [&](const LinksAtAngle& at) {
    return [&model, &drive, angle = at.angle](double speed, double) {
      const LinkMomentum p = linkMomentum(model, angle, speed);
      return HullWrench{p.x, p.z, p.about_d + drive.by_crank * speed};
    };
  });
  return deviationOf(g, covariance);
}

WrenchSpread wrenchSpread(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                          const LinksBeside& links, const Eigen::Matrix3d& covariance) noexcept {
  WrenchSpread spread;
  if (!(covariance(1, 1) > 0.0)) return spread;
  const HullMotion at_rest;
  const Gradient g =
      gradient(crank, links, [&](const LinksAtAngle& at) { return WrenchAtAngle(model, drive, at_rest, at); });
  const Eigen::Matrix3d errors = g * root(covariance);
  spread.count = 3;
  for (int i = 0; i < 3; ++i) {
    Wrench& part = spread.part[static_cast<std::size_t>(i)];
    part = {{errors(0, i), 0.0, errors(1, i)}, {0.0, errors(2, i), 0.0}};
  }
  return spread;
}

}  // namespace hammer_loads
