// Deviations of a sample, by what crank, connecting rod and contact with the tool leave open.
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

constexpr double kBegins = 2.0 * kSlowCrank;  // [rad/s]: a crank that has hardly begun to turn
constexpr double kBounces = 200.0;            // [rad/s2] of a slow crank whose rocker bounces on the tool

}  // namespace

/// Covariance of the wrench, by the probability that the last blow met no tool, or one that the estimate does not know
/// of. A slow crank may also land on the tool, leave it or rest there: then the tool stops the links and carries the
/// rocker.
Eigen::Matrix3d Pipeline::contactDoubt(const LinkMotion& links, const DriveReaction& drive) const noexcept {
  const bool lands = std::abs(result_.crank.speed) < kSlowCrank && transmissionAngle(links) < settings_.near_blow;
  const double probability = lands ? 1.0 : crank_.tracker().otherBranch();
  if (!(probability > 0.0)) return Eigen::Matrix3d::Zero();
  const HullMotion& hull = hull_.motion().motion;
  CrankMotion other = motionOf(result_.crank);
  const HullWrench here = hullWrench(model_, drive, links, other, hull);
  if (lands) {
    other.speed = other.acceleration = 0.0;
  } else {
    other.angle.side = opposite(other.angle.side);
  }
  HullWrench there = hullWrench(model_, drive, other, hull);
  if (lands) there = there + rockerOnTool(mechanism_, links, hull.gravity);
  const Eigen::Vector3d doubt = vectorOf(there) - vectorOf(here);
  return probability * doubt * doubt.transpose();
}

/// Covariance of the wrench by a zero that no turn has shown yet: the wrench at both ends of the zero's range, as it is
/// not linear in it. It includes the weight of a slow rocker, which the tool may carry, and the error of the drive
/// inertia.
Eigen::Matrix3d Pipeline::zeroDoubt(const DriveReaction& drive) const noexcept {
  const ConstantErrors& errors = crank_.tracker().constantErrors();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  if (errors.knows() && errors.zeroIsShown()) return covariance;
  const HullMotion& hull = hull_.motion().motion;
  const CrankMotion motion = motionOf(result_.crank);
  const HammerParameters& p = mechanism_.parameters();
  const double inertia = std::max(p.drive_inertia, crank_.tracker().driveInertia());
  if (std::abs(motion.speed) < kBegins) {
    const double weight = p.rocker_mass * std::hypot(hull.gravity.x, hull.gravity.z);
    const double torque = std::hypot(weight * p.rocker_com_distance, inertia * kBounces);
    covariance.diagonal() = Eigen::Vector3d(weight, weight, torque).cwiseAbs2();
  }
  covariance(2, 2) += square(settings_.initial_inertia_std * inertia * motion.acceleration);
  if (errors.zeroIsShown()) return covariance;  // given so well that it is linear
  const Eigen::Vector3d here = vectorOf(hullWrench(model_, drive, motion, hull));
  for (const double sign : {-1.0, 1.0}) {
    CrankMotion other = motion;
    other.angle.offset = CrankAngle::wrapToPi(motion.angle.offset + sign * gate::kUsual * errors.zeroDeviation());
    const Eigen::Vector3d beside = (vectorOf(hullWrench(model_, drive, other, hull)) - here) / gate::kUsual;
    covariance += 0.5 * beside * beside.transpose();
  }
  return covariance;
}

/// Deviations, and whether the blow's side is certain. Returns the loads that an elastic connecting rod adds.
ElasticFollower::Beside Pipeline::weigh(const LinksBeside& links, const DriveReaction& drive) noexcept {
  const bool gives = elastic_.runs();
  result_.doubt = crank_.tracker().uncertainty(settings_.torque_std_part);
  result_.deviation = hullDeviation(columns_, model_, crank_.tracker().driveInertia(), result_.crank, links,
                                    hull_.motion().motion, result_.doubt, result_.load_columns);
  if (gives) {
    result_.deviation.wrench = result_.deviation.common;
    result_.deviation.correlation = result_.deviation.common_correlation;
  }
  const ElasticFollower::Beside rod =
      gives ? elastic_.beside(drive, rod_.acceleration())
            : ElasticFollower::Beside{{}, rod_.covariance(links.here.links, result_.crank.speed)};
  result_.rod_ring = wrenchOf(rod.covariance.diagonal().cwiseMax(0.0).cwiseSqrt());
  result_.rod_followed = gives;
  unknown_.vibrates(links.here.links, gives ? elastic_.vibration() : std::sqrt(2.0) * rod_.acceleration());
  const UnknownForce::Errors unknown = unknown_.errors(links.here.links);
  result_.unknown = unknown.squares;
  result_.rod_momentum = rockerWrench(mechanism_, links.here.links, rod_.speed());
  const Eigen::Matrix3d contact = contactDoubt(links.here.links, drive);
  result_.beside = rod.covariance + contact + zeroDoubt(drive) + unknown.covariance;
  addCovariance(result_.beside, result_.deviation);
  const CrankFilter& tracker = crank_.tracker();
  // An encoder's edge shows the side of the blow as far as the zero is known.
  const double of_angle =
      tracker.readingShowsSide() ? tracker.constantErrors().zeroDeviation() : result_.deviation.angle;
  const std::optional<bool> beside_rods = gives ? std::make_optional(elastic_.isBesideBlow()) : std::nullopt;
  result_.beside_blow = isBesideBlow(tracker, result_.crank, of_angle, beside_rods);
  result_.uncertain = !isKnown();
  return rod;
}

}  // namespace hammer_loads
