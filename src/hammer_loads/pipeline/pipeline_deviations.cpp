// Deviations of a sample: what the crank, the rod and the contact with the tool leave open.
#include <cmath>

#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {
namespace {

/// Largest value of each component of the rocker's weight.
HullWrench rockersWeight(const HammerParameters& p, const Gravity& gravity) noexcept {
  const double weight = p.rocker_mass * std::hypot(gravity.x, gravity.z);
  return {weight, weight, weight * p.rocker_com_distance};
}

}  // namespace

/// Covariance of the wrench if the last blow met no tool, or one that the estimate does not know of, by its
/// probability; and, where a slow crank lands on the tool, leaves it or rests there, if that takes what moves and
/// carries the rocker. Where that is, is not known before blows have shown the zero: then the rocker's weight is in
/// doubt.
Eigen::Matrix3d Pipeline::contactDoubt(const LinkMotion& links, const DriveReaction& drive) const noexcept {
  const bool slow = std::abs(result_.crank.speed) < kSlowCrank;
  const bool lands = slow && transmissionAngle(links) < settings_.near_blow;
  const double probability = lands ? 1.0 : crank_.tracker().otherBranch();
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();
  if (slow && !crank_.tracker().constantErrors().knows())
    weight = vectorOf(rockersWeight(mechanism_.parameters(), hull_.gravity())).cwiseAbs2().asDiagonal();
  if (!(probability > 0.0)) return weight;
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
  const Eigen::Vector3d beside = vectorOf(there) - vectorOf(here);
  return probability * beside * beside.transpose() + weight;
}

/// Deviations, and whether the blow's side is certain. Returns what a rod that gives adds to the loads.
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
  result_.unknown = unknown_.squares(links.here.links);
  const Eigen::Matrix3d contact = contactDoubt(links.here.links, drive);
  result_.contact_doubt = wrenchOf(contact.diagonal().cwiseSqrt());
  result_.rod_momentum = rockerWrench(mechanism_, links.here.links, rod_.speed());
  result_.beside = rod.covariance + contact + unknown_.covariance(links.here.links);
  addCovariance(result_.beside, result_.deviation);
  const CrankFilter& tracker = crank_.tracker();
  // An encoder's edge shows the side of the blow as far as the zero is known.
  const double of_angle =
      tracker.readingShowsSide() ? tracker.constantErrors().zeroDeviation() : result_.deviation.angle;
  result_.beside_blow =
      gives ? elastic_.isBesideBlow()
            : isBesideBlow(result_.crank, deviationFromBlow(tracker, of_angle),
                           tracker.constantErrors().knows() ? gate::kUsual : gate::kRare);  // couplings slip by 10 deg
  result_.uncertain = !isKnown();
  return rod;
}

}  // namespace hammer_loads
