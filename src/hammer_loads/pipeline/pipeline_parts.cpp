// Steps of a sample other than crank and wrench: deviations, hull, boom, misuse.
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/pipeline.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kBegins = 2.0 * kSlowCrank;  // [rad/s]: a crank that has hardly begun to turn

constexpr double kLeadOfZero = 0.6;  // part of the zero's time at the blow that acts on the vibration
constexpr double kLateImu = 5e-3;    // [s]: with pressures, older readings of the IMU make the torques worse

}  // namespace

/// Returns the covariance due to the probability that the last blow was a blank firing, or that the estimate missed a
/// blow. A slow crank may also land on the tool, leave it or rest there. Then the tool stops the links and carries the
/// rocker.
Eigen::Matrix3d Pipeline::contactCovariance(const LinkMotion& links, const DriveReaction& drive) const noexcept {
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
  const Eigen::Vector3d change = vectorOf(there) - vectorOf(here);
  return probability * change * change.transpose();
}

/// Returns the covariance due to a zero that no revolution has shown yet. It follows from the wrench at both ends of
/// the zero's range, as it is not linear. It includes the weight of a slow rocker, which the tool may carry, and the
/// error of the drive inertia.
Eigen::Matrix3d Pipeline::zeroCovariance(const DriveReaction& drive) const noexcept {
  const ConstantErrors& errors = crank_.tracker().constantErrors();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  if (errors.isKnown() && errors.zeroIsShown()) return covariance;
  const HullMotion& hull = hull_.motion().motion;
  const CrankMotion motion = motionOf(result_.crank);
  const HammerParameters& p = mechanism_.parameters();
  const double inertia = std::max(p.drive_inertia, crank_.tracker().driveInertia());
  if (std::abs(motion.speed) < kBegins) {
    const double weight = p.rocker_mass * std::hypot(hull.gravity.x, hull.gravity.z);
    covariance.diagonal() = Eigen::Vector3d(weight, weight, weight * p.rocker_com_distance).cwiseAbs2();
  }
  covariance(2, 2) += square(settings_.initial_inertia_std * inertia * motion.acceleration);
  if (errors.zeroIsShown()) return covariance;  // given so well that it is linear
  const Eigen::Vector3d here = vectorOf(hullWrench(model_, drive, motion, hull));
  for (const double sign : {-1.0, 1.0}) {
    CrankMotion other = motion;
    other.angle.offset = CrankAngle::wrapToPi(motion.angle.offset + sign * gate::kUsual * errors.zeroDeviation());
    const Eigen::Vector3d change = (vectorOf(hullWrench(model_, drive, other, hull)) - here) / gate::kUsual;
    covariance += 0.5 * change * change.transpose();
  }
  return covariance;
}

/// Finds the standard deviations and whether the blow's side is certain. Returns the loads that an elastic rod adds.
ElasticFollower::RodLoads Pipeline::computeDeviations(const LinksForGradient& links,
                                                      const DriveReaction& drive) noexcept {
  const bool follows_rod = elastic_.runs();
  result_.uncertainty = crank_.tracker().uncertainty(settings_.torque_std_part);
  result_.deviation = hullDeviation(columns_, model_, crank_.tracker().driveInertia(), result_.crank, links,
                                    hull_.motion().motion, result_.uncertainty, result_.load_columns);
  if (follows_rod) result_.deviation.covariance = result_.deviation.common_covariance;
  const ElasticFollower::RodLoads rod =
      follows_rod ? elastic_.rodLoads(drive, rod_.acceleration())
                  : ElasticFollower::RodLoads{{}, rod_.covariance(links.here.links, result_.crank.speed)};
  result_.rod_ring = wrenchOf(rod.covariance.diagonal().cwiseMax(0.0).cwiseSqrt());
  result_.rod_followed = follows_rod;
  unknown_.vibrates(links.here.links, follows_rod ? elastic_.vibration() : std::sqrt(2.0) * rod_.acceleration());
  const UnknownForce::Errors unknown = unknown_.errors(links.here.links);
  result_.unknown = unknown.squares;
  result_.rod_momentum = rockerWrench(mechanism_, links.here.links, rod_.speed());
  const Eigen::Matrix3d contact = contactCovariance(links.here.links, drive);
  result_.other_covariance = rod.covariance + contact + zeroCovariance(drive) + unknown.covariance;
  result_.deviation.covariance += result_.other_covariance;
  const CrankFilter& tracker = crank_.tracker();
  // An encoder's edge shows the side of the blow as far as the zero is known.
  const double of_angle = tracker.readingShowsSide() ? 0.0 : result_.deviation.angle;
  const std::optional<bool> beside_rods = follows_rod ? std::make_optional(elastic_.isBesideBlow()) : std::nullopt;
  result_.beside_blow = isBesideBlow(tracker, result_.crank, of_angle, beside_rods);
  result_.uncertain = !isKnown();
  return rod;
}

bool Pipeline::boomJoints(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                          const std::vector<double>& velocities) noexcept {
  const bool of_boom = boom_ && boom_->jointStates(stamp, names, positions, velocities);
  return hull_.joints(names, positions) || of_boom;
}

double Pipeline::stampNoise() const noexcept { return crank_.tracker().timingNoise(); }

/// Returns the lead of the crank's angle due to the zero error that the filter sees. speed: at the blow [rad/s].
CrankLead Pipeline::crankLead(double speed) const noexcept {
  if (!(speed > 0.0)) return {};
  const ConstantErrors& errors = crank_.tracker().constantErrors();
  const double by_angle = kLeadOfZero / speed;
  return {by_angle * errors.estimate()[0], by_angle * errors.deviation()[0]};
}

void Pipeline::followBoom(const LinksForGradient& links, const DriveReaction& drive) noexcept {
  const CrankMotion crank = motionOf(result_.crank);
  const HullWrench motion = hullWrench(model_, drive, links.here.links, crank, Gravity{});
  const HullWrench displaced = displaced_links_.wrench(links.here.links, crank.speed, hull_.motion().motion);
  const WrenchHistory step = boom_follows_ ? wrenchHistory(model_, crank_.step()) : WrenchHistory{};
  const WrenchSpread spread =
      wrenchSpread(model_, drive, result_.crank, links, result_.uncertainty.own, result_.load_columns);
  const bool at_work = std::abs(crank.speed) > kSlowCrank;
  const double most_age = boom_->pressuresCount() ? kLateImu : look_back::kLine;
  const std::optional<StampedImuReading> imu = hull_.newImuReading(result_.stamp, boom_->imuStampsJitter(), most_age);
  const bool imu_lost = at_work && hull_.imuTrust().isLost();  // an IMU on a hull at rest may repeat its readings
  result_.boom = &boom_->sample(
      {result_.stamp, motion, spread, constantErrors(result_.load_columns), hammerErrors(result_.load_columns), imu,
       imu_lost, displaced, stampNoise(), at_work ? nominal_force_ : 0.0},
      step);
  boom_follows_ = true;
  for (std::size_t i = 0; i < result_.turn_ends; ++i) {
    boom_->turnEnded(result_.ends[i].pulse, result_.ends[i].mean_hold_down_force);
    boom_->expectCrankLead(crankLead(result_.ends[i].blow.crank_speed_before));
  }
}

/// Advances the boom over a sample without a result.
void Pipeline::advanceBoom(const WrenchHistory& step) noexcept {
  if (boom_follows_) {
    boom_->advanceWithoutLoads(result_.stamp, step);
    hull_.vibrates(&*boom_);
  } else {
    hull_.clearVibration();
  }
  hullMovedAtBlow();
}

/// Passes on the hull velocity at the blow: vibration from the IMU or else from the boom's model, plus the operator's
/// motion, which the IMU does not show.
void Pipeline::hullMovedAtBlow() noexcept {
  if (!turn_.blowWaits()) return;
  std::optional<TipVelocity> speed = hull_.speedAtBlow();
  if (!speed && boom_) speed = boom_->state().at_blow;
  if (!speed) return;
  const TipVelocity driven = boom_ ? boom_->drivenTip() : TipVelocity{};
  turn_.hullMovedAtBlow({speed->z + driven.z, speed->rate + driven.rate});
}

/// Notes the blows, at which measured accelerations of the hull jump.
void Pipeline::passBlows() noexcept {
  for (const CrankStep::Passage& passage : crank_.step())
    if (passage.strikes) hull_.struck(crank_.step().stampAt(passage.time));
}

/// Follows the hull's motion, which the load of links and drive over the step drives and the IMU measures.
void Pipeline::followHull() noexcept {
  if (!hull_.followsLoad()) return;
  const CrankMotion crank = motionOf(result_.crank);
  const HullWrench displaced = displaced_links_.wrench(crank_.step().links().links, crank.speed, hull_.motion().motion);
  hull_.follow(result_.stamp, wrenchHistory(model_, crank_.step()), displaced);
  crank_.hullMoved(hull_.motion().motion);
  result_.crank = crank_.estimate();
}

void Pipeline::followMisuse() noexcept {
  const bool placed = boom_->known();
  if (placed)
    misuse_.hullAt(boom_->boom().pose().tip().translation());
  else
    misuse_.hullLost();
  misuse_.pressed(placed && boom_->contactKnown() ? std::make_optional(!boom_->state().hold_down_force_lost)
                                                  : std::nullopt);
  for (std::size_t i = 0; i < result_.turn_ends; ++i) {
    const std::optional<HalfSinePulse>& pulse = result_.ends[i].pulse;
    const std::optional<bool> pressed = misuse_.blow(pulse ? std::make_optional(pulse->period) : std::nullopt);
    if (pressed.value_or(false)) result_.ends[i].struck = TurnEnd::Struck::kTool;
  }
}

}  // namespace hammer_loads
