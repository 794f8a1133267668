#include "hammer_loads/pipeline/hull_deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/covariance_root.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/pipeline/crank_follower.h"

namespace hammer_loads {
namespace {

constexpr double kStands = 0.05;  // [rad/s]: largest speed of a crank at rest

// One-sided differences: relative errors of 1e-6 by curvature and 1e-9 by rounding.
constexpr double kAngleStep = 1e-6, kSpeedStep = 1e-5, kAccelerationStep = 1e-2;  // [rad], [rad/s], [rad/s2]
// Numerical: kAngleStep, kSpeedStep, kAccelerationStep

using Gradient = Eigen::Matrix3d;  // rows: force_x, force_z, torque_y

CrankAngle nudged(CrankAngle angle) noexcept {
  angle.offset += kAngleStep;  // the side stays: the branch's own continuation past the blow
  return angle;
}

/// Returns the gradient; at_angle(links) returns the wanted value as a function of speed and acceleration.
template <typename AtAngle>
Gradient gradient(const CrankEstimate& crank, const LinksForGradient& links, const AtAngle& at_angle) noexcept {
  const double speed = crank.speed, acceleration = crank.acceleration;
  const auto here = at_angle(links.here), stepped = at_angle(links.stepped);
  const Eigen::Vector3d value = vectorOf(here(speed, acceleration));
  const auto slope = [&](const HullWrench& moved, double step) {
    return Eigen::Vector3d((vectorOf(moved) - value) * (1.0 / step));
  };
  Gradient result;
  result << slope(stepped(speed, acceleration), kAngleStep), slope(here(speed + kSpeedStep, acceleration), kSpeedStep),
      slope(here(speed, acceleration + kAccelerationStep), kAccelerationStep);
  return result;
}

HullDeviation unknownDeviation() noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kUnknown);
  return {covariance, covariance, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
}

/// Returns the wrench at one crank angle as a function of speed and acceleration.
auto wrenchAt(const HullModel& model, const DriveReaction& drive, const HullMotion& hull,
              const LinksAtAngle& at) noexcept {
  return [&](double speed, double acceleration) {
    return hullWrench(model, drive, at.links, {at.angle, speed, acceleration}, hull);
  };
}

}  // namespace

Eigen::Vector3d HullDeviation::correlationOf(const Eigen::Matrix3d& covariance) noexcept {
  const auto coefficient = [&](int i, int k) {
    const double square = covariance(i, i) * covariance(k, k);
    return square > 0.0 ? std::clamp(covariance(i, k) / std::sqrt(square), -1.0, 1.0) : 0.0 * square;
  };
  return {coefficient(0, 1), coefficient(0, 2), coefficient(1, 2)};
}

LinksForGradient::LinksForGradient(const HullModel& model, const LinksAtAngle& at) noexcept
    : here(at), stepped(linksAt(model, nudged(at.angle))) {}

HullDeviation hullDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                            const LinksForGradient& links, const HullMotion& hull,
                            const Eigen::Matrix3d& covariance) noexcept {
  if (!(covariance(1, 1) > 0.0)) return unknownDeviation();
  const Gradient g = gradient(crank, links, [&](const LinksAtAngle& at) { return wrenchAt(model, drive, hull, at); });
  return {g * covariance * g.transpose(), Eigen::Matrix3d::Zero(), std::sqrt(covariance(0, 0)),
          std::sqrt(covariance(1, 1)), std::sqrt(covariance(2, 2))};
}

HullDeviation hullDeviation(const WrenchColumns& hammer, const HullModel& model, double drive_inertia,
                            const CrankEstimate& crank, const LinksForGradient& links, const HullMotion& hull,
                            const CrankUncertainty& uncertainty, LoadColumns& columns) noexcept {
  columns.setZero();
  if (!(uncertainty.own(1, 1) > 0.0)) return unknownDeviation();
  const DriveReaction drive = driveReaction(model, drive_inertia), none = driveReaction(model, 0.0);
  const Gradient g = gradient(crank, links, [&](const LinksAtAngle& at) { return wrenchAt(model, drive, hull, at); });
  columns.leftCols<ConstantErrors::kSize>() = g.cast<float>().lazyProduct(uncertainty.by_constant.topRows<3>());
  columns.middleCols<kMachineColumns>(ConstantErrors::kTable) +=
      hammer.wrench(drive_inertia, links.here, motionOf(crank), hull);
  const double by_inertia =
      drive.torque(crank.acceleration, hull.acceleration) - none.torque(crank.acceleration, hull.acceleration);
  columns.row(2).head<ConstantErrors::kSize>() +=
      static_cast<float>(by_inertia) * uncertainty.by_constant.row(CrankUncertainty::kInertia);
  columns(2, kInertiaColumn) = static_cast<float>(by_inertia * uncertainty.inertia);
  const Eigen::Matrix3d common = covarianceOf(columns);
  const Eigen::Matrix3d all = g * uncertainty.own * g.transpose() + common;
  const Eigen::Vector3d of_crank = uncertainty.by_constant.topRows<3>().rowwise().squaredNorm().cast<double>();
  const Eigen::Vector3d crank_all = (uncertainty.own.diagonal() + of_crank).cwiseSqrt();
  return {all,
          common,
          crank_all[0],
          crank_all[1],
          crank_all[2],
          std::sqrt(of_crank[0]),
          std::sqrt(of_crank[1]),
          std::sqrt(of_crank[2])};
}

void addHullMotion(const HullModel& model, const DriveReaction& drive, const LinkMotion& links, double crank_speed,
                   const HullMotion& hull, const HullMotionCovariance& covariance, HullDeviation& deviation) noexcept {
  if (covariance.isZero(0.0)) return;
  const auto load = [&](const HullMotion& h) { return vectorOf(frameWrench(model, links, crank_speed, h)); };
  Eigen::Matrix<double, 3, 4> by;
  by.col(0) = load({{1.0, 0.0}, 0.0, 0.0}), by.col(1) = load({{0.0, 1.0}, 0.0, 0.0});
  by.col(2).setZero();
  if (covariance(2, 2) > 0.0)  // exact, as the load is quadratic in the rate
    by.col(2) = 0.5 * (load({{0.0, 0.0}, hull.rate + 1.0, 0.0}) - load({{0.0, 0.0}, hull.rate - 1.0, 0.0}));
  by.col(3) = load({{0.0, 0.0}, 0.0, 1.0});
  by(2, 3) -= drive.by_hull;
  deviation.covariance += (by.lazyProduct(covariance)).eval().lazyProduct(by.transpose());
}

HullWrench momentumDeviation(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                             const LinksForGradient& links, const Eigen::Matrix3d& covariance) noexcept {
  const Gradient g = gradient(crank, links, [&](const LinksAtAngle& at) {
    return [&](double speed, double) {
      const LinkMomentum p = linkMomentum(model, at.links, at.angle, speed);
      return HullWrench{p.x, p.z, p.about_d + drive.by_crank * speed};
    };
  });
  return HullDeviation::deviationOf(g * covariance * g.transpose());
}

MomentumColumns momentumColumns(const WrenchColumns& hammer, const HullModel& model, CrankAngle angle, double speed,
                                const ConstantErrors::Row& of_speed) noexcept {
  MomentumColumns columns = MomentumColumns::Zero();
  const auto momentum = [&](const HullModel& of, double at) {
    const LinkMomentum p = linkMomentum(of, angle, at);
    return Eigen::Vector2d(p.x, p.z);
  };
  const Eigen::Vector2d here = momentum(model, speed);
  const auto hammers = static_cast<Eigen::Index>(hammer.models().size());
  for (Eigen::Index i = 0; i < ConstantErrors::kSize; ++i) {
    const Eigen::Index k = i - ConstantErrors::kTable;
    if (k >= 0 && k < hammers) {
      const double step = hammer.step(static_cast<std::size_t>(k));
      columns.col(i) =
          (momentum(hammer.models()[static_cast<std::size_t>(k)], speed + step * of_speed[i]) - here) / step;
    } else if (of_speed[i] != 0.0) {
      columns.col(i) = momentum(model, speed + of_speed[i]) - here;
    }
  }
  return columns;
}

MomentumColumns weightColumns(const WrenchColumns& hammer, const HullModel& model, Gravity gravity) noexcept {
  MomentumColumns columns = MomentumColumns::Zero();
  const double here = movingMass(model.mechanism(), model.level());
  for (std::size_t i = 0; i < hammer.models().size(); ++i) {
    const HullModel& other = hammer.models()[i];
    const double mass = (movingMass(other.mechanism(), other.level()) - here) / hammer.step(i);
    columns.col(ConstantErrors::kTable + static_cast<Eigen::Index>(i)) << mass * gravity.x, mass * gravity.z;
  }
  return columns;
}

WrenchSpread wrenchSpread(const HullModel& model, const DriveReaction& drive, const CrankEstimate& crank,
                          const LinksForGradient& links, const Eigen::Matrix3d& own,
                          const LoadColumns& columns) noexcept {
  if (!(own(1, 1) > 0.0)) return {};
  const HullMotion at_rest;
  const Gradient g =
      gradient(crank, links, [&](const LinksAtAngle& at) { return wrenchAt(model, drive, at_rest, at); });
  const auto of_sensor = columns.leftCols<ConstantErrors::kTable>();
  const Eigen::Matrix3d errors = covarianceRoot<3>(g * own * g.transpose() + covarianceOf(of_sensor));
  WrenchSpread spread;
  spread.count = 3;
  for (int i = 0; i < 3; ++i) {
    Wrench& part = spread.part[static_cast<std::size_t>(i)];
    part = {{errors(0, i), 0.0, errors(1, i)}, {0.0, errors(2, i), 0.0}};
  }
  return spread;
}

Eigen::Matrix3d constantErrors(const LoadColumns& columns) noexcept { return covarianceRoot<3>(covarianceOf(columns)); }

Eigen::Matrix3d hammerErrors(const LoadColumns& columns) noexcept {
  return covarianceRoot<3>(covarianceOf(columns.middleCols<kMachineColumns>(ConstantErrors::kTable)));
}

double deviationFromBlow(const CrankFilter& filter, double angle_std) noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  if (!filter.rodEvidence().showsElasticRod()) return std::hypot(angle_std, errors.zeroSeen());
  const double hidden = errors.zeroIsGiven() ? 0.0 : ConstantErrors::kRodHides;
  return std::hypot(angle_std, std::hypot(errors.zeroLooks(), hidden));
}

bool isBesideBlow(const CrankEstimate& crank, double distance) noexcept {
  const CrankPosition& at = crank.position;
  return std::abs(at.angle.offset) < distance && std::abs(crank.speed) > kSlowCrank && !at.isMirrored();
}

/// Before the zero is known, a slow crank near the blow may have met the tool, or bounce on it. An elastic rod's filter
/// determines the contacts better than the zero does.
bool isBesideBlow(const CrankFilter& filter, const CrankEstimate& crank, double angle_std,
                  std::optional<bool> rod) noexcept {
  const ConstantErrors& errors = filter.constantErrors();
  if (rod && (*rod || errors.zeroIsShown())) return *rod;
  if (!errors.zeroIsShown() && crank.position.isMirrored()) return true;
  const double of_zero = errors.zeroDeviation(), of_angle = rod ? of_zero : std::max(angle_std, of_zero);
  const double distance = gate::kUsual * deviationFromBlow(filter, of_angle);
  // On the wrong side the wrench is off by its whole jump; hence the gate kRare for angle and zero.
  if (errors.zeroIsShown() && of_zero < ConstantErrors::kCalibratedZero)
    return isBesideBlow(crank, std::max(gate::kRare * of_angle, distance));
  return std::abs(crank.position.angle.offset) < distance && std::abs(crank.speed) > kStands;
}

}  // namespace hammer_loads
