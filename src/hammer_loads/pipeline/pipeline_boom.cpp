// Effect of the crank's motion on hull and boom, and misuse by the boom's sensors.
#include <cmath>

#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {
namespace {

constexpr double kAtWork = 0.3;      // part of the nominal speed at which blows are struck
constexpr double kLeadOfZero = 0.6;  // part of the zero's time at the blow that acts on the vibration

}  // namespace

bool Pipeline::boomJoints(StampNs stamp, const std::vector<std::string>& names, const std::vector<double>& positions,
                          const std::vector<double>& velocities) noexcept {
  const bool of_boom = boom_ && boom_->jointStates(stamp, names, positions, velocities);
  return hull_.joints(names, positions) || of_boom;
}

double Pipeline::stampNoise() const noexcept { return crank_.tracker().timingNoise(); }

/// Lead of the crank's angle by the zero error that the filter sees. speed: of the crank at the blow [rad/s].
CrankLead Pipeline::crankLead(double speed) const noexcept {
  if (!(speed > 0.0)) return {};
  const ConstantErrors& errors = crank_.tracker().constantErrors();
  const double by_angle = kLeadOfZero / speed;
  return {by_angle * errors.estimate()[0], by_angle * errors.deviation()[0]};
}

void Pipeline::followBoom(const LinksBeside& links, const DriveReaction& drive) noexcept {
  const CrankMotion crank = motionOf(result_.crank);
  const HullWrench motion = hullWrench(model_, drive, links.here.links, crank, Gravity{});
  const HullWrench displaced = displaced_links_.wrench(links.here.links, crank.speed, hull_.motion().motion);
  const WrenchHistory step = boom_follows_ ? wrenchHistory(model_, crank_.step()) : WrenchHistory{};
  const WrenchSpread spread =
      wrenchSpread(model_, drive, result_.crank, links, result_.doubt.own, result_.load_columns);
  const bool at_work = std::abs(crank.speed) > kAtWork * kTwoPi * settings_.turn_rate;
  const bool imu_lost = at_work && hull_.imuTrust().isLost();  // a hull at rest may show the same again and again
  result_.boom =
      &boom_->sample({result_.stamp, motion, spread, constantErrors(result_.load_columns),
                      hammerErrors(result_.load_columns), hull_.newImuReading(result_.stamp, boom_->imuStampsJitter()),
                      imu_lost, displaced, stampNoise(), at_work ? nominal_force_ : 0.0},
                     step);
  boom_follows_ = true;
  for (std::size_t i = 0; i < result_.turn_ends; ++i) {
    boom_->turnEnded(result_.ends[i].pulse, result_.ends[i].mean_hold_down_force);
    boom_->expectCrankLead(crankLead(result_.ends[i].blow.crank_speed_before));
  }
}

/// Advances the boom over a sample without a result.
void Pipeline::swingOn(const WrenchHistory& step) noexcept {
  if (boom_follows_) {
    boom_->swing(result_.stamp, step);
    hull_.vibrates(&*boom_);
  } else {
    hull_.rest();
  }
  hullMovedAtBlow();
}

/// Hull velocity at the blow: vibration by the IMU or else by the boom's model, plus the operator's motion, which the
/// IMU does not show.
void Pipeline::hullMovedAtBlow() noexcept {
  if (!turn_.blowWaits()) return;
  std::optional<TipVelocity> speed = hull_.speedAtBlow();
  if (!speed && boom_) speed = boom_->state().at_blow;
  if (!speed) return;
  const TipVelocity driven = boom_ ? boom_->drivenTip() : TipVelocity{};
  turn_.hullMovedAtBlow({speed->z + driven.z, speed->rate + driven.rate});
}

/// Measured accelerations of the hull jump at a blow.
void Pipeline::passBlows() noexcept {
  for (const CrankStep::Passage& passage : crank_.step())
    if (passage.strikes) hull_.struck(crank_.step().stampAt(passage.time));
}

/// The load of links and drive over the step drives the hull that its IMU sees.
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
