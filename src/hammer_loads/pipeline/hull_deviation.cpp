#include "hammer_loads/pipeline/hull_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hammer_loads {
namespace {

constexpr double kStep[] = {1e-5, 1e-3, 1e-2};  // of angle [rad], speed [rad/s], acceleration [rad/s2]

using Gradient = Eigen::Matrix3d;  // rows: force_x, force_z, torque_y

Eigen::Vector3d vectorOf(const HullWrench& w) noexcept { return {w.force_x, w.force_z, w.torque_y}; }

/// f(angle, speed, acceleration moved by so much) by central differences, `columns` of them.
template <typename Function>
Gradient gradient(int columns, const Function& f) noexcept {
  Gradient result = Gradient::Zero();
  for (int i = 0; i < columns; ++i) {
    Eigen::Vector3d move = Eigen::Vector3d::Zero();
    move[i] = kStep[i];
    result.col(i) = (vectorOf(f(move)) - vectorOf(f(-move))) / (2.0 * kStep[i]);
  }
  return result;
}

HullWrench deviationOf(const Gradient& g, const Eigen::Matrix3d& covariance) noexcept {
  const auto deviation = [&](int row) {
    return std::sqrt(std::max(0.0, g.row(row).dot(covariance * g.row(row).transpose())));
  };
  return {deviation(0), deviation(1), deviation(2)};
}

CrankAngle moved(CrankAngle angle, double by) noexcept {
  angle.offset += by;  // the side stays: the branch's own continuation past the blow
  return angle;
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

HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                            const HullMotion& hull, const Eigen::Matrix3d& covariance) noexcept {
  if (!(covariance(1, 1) > 0.0)) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    return {{kUnknown, kUnknown, kUnknown}, kUnknown, kUnknown, kUnknown};
  }
  const Gradient g = gradient(3, [&](const Eigen::Vector3d& by) noexcept {
    return hullWrench(model, drive,
                      {moved(crank.position.angle, by[0]), crank.speed + by[1], crank.acceleration + by[2]}, hull);
  });
  return {deviationOf(g, covariance), std::sqrt(covariance(0, 0)), std::sqrt(covariance(1, 1)),
          std::sqrt(covariance(2, 2))};
}

HullWrench momentumDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                             const Eigen::Matrix3d& covariance) noexcept {
  const Gradient g = gradient(2, [&](const Eigen::Vector3d& by) noexcept {
    const LinkMomentum p = linkMomentum(model, moved(crank.position.angle, by[0]), crank.speed + by[1]);
    return HullWrench{p.x, p.z, p.about_d + drive.by_crank * by[1]};
  });
  return deviationOf(g, covariance);
}

WrenchSpread wrenchSpread(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                          const Eigen::Matrix3d& covariance) noexcept {
  WrenchSpread spread;
  if (!(covariance(1, 1) > 0.0)) return spread;
  const Gradient g = gradient(3, [&](const Eigen::Vector3d& by) noexcept {
    return motionWrench(model, drive,
                        {moved(crank.position.angle, by[0]), crank.speed + by[1], crank.acceleration + by[2]});
  });
  const Eigen::Matrix3d errors = g * root(covariance);
  spread.count = 3;
  for (int i = 0; i < 3; ++i) {
    Wrench& part = spread.part[static_cast<std::size_t>(i)];
    part = {{errors(0, i), 0.0, errors(1, i)}, {0.0, errors(2, i), 0.0}};
  }
  return spread;
}

}  // namespace hammer_loads
