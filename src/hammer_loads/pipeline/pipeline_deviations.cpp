// Deviations of a sample, by what crank, connecting rod and contact with the tool leave open.
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {

/// Standard deviation of the wrench, with signs, by the probability that the last blow met no tool, or one that the
/// estimate does not know of. A slow crank may also land on the tool, leave it or rest there: then the tool stops the
/// links and carries the rocker.
HullWrench Pipeline::contactDoubt(const LinkMotion& links, const DriveReaction& drive) const noexcept {
  const bool lands = std::abs(result_.crank.speed) < kSlowCrank && transmissionAngle(links) < settings_.near_blow;
  const double probability = lands ? 1.0 : crank_.tracker().otherBranch();
  if (!(probability > 0.0)) return {};
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
  return wrenchOf(std::sqrt(probability) * (vectorOf(there) - vectorOf(here)));
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
  result_.contact_doubt = contactDoubt(links.here.links, drive);
  result_.rod_momentum = rockerWrench(mechanism_, links.here.links, rod_.speed());
  const Eigen::Vector3d doubt = vectorOf(result_.contact_doubt);
  result_.beside = rod.covariance + doubt * doubt.transpose() + unknown.covariance;
  addCovariance(result_.beside, result_.deviation);
  const CrankFilter& tracker = crank_.tracker();
  // An encoder's edge shows the side of the blow as far as the zero is known.
  const double of_angle =
      tracker.readingShowsSide() ? tracker.constantErrors().zeroDeviation() : result_.deviation.angle;
  result_.beside_blow =
      gives ? elastic_.isBesideBlow() : isBesideBlow(result_.crank, deviationFromBlow(tracker, of_angle));
  result_.uncertain = !isKnown();
  return rod;
}

}  // namespace hammer_loads
