// What the crank's motion is to the boom, and what the boom shows of how the machine is used.
#include <cmath>

#include "hammer_loads/pipeline/pipeline.h"

namespace hammer_loads {
namespace {

constexpr double kAtWork = 0.3;  // of the nominal speed: blows are struck
constexpr double kLeadOfZero = 0.6;  // of the time that the crank needs at the blow: what a zero makes of the vibration

}  // namespace

double Pipeline::stampNoise() const noexcept { return crank_.tracker().timingNoise(); }

/// By the sensor's zero, as the filter sees it. speed: of the crank at the blow [rad/s].
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
    boom_->turnEnded(result_.ends[i].pulse, result_.ends[i].mean_press_force);
    boom_->expectCrankLead(crankLead(result_.ends[i].blow.crank_speed_before));
  }
}

void Pipeline::followMisuse() noexcept {
  const bool placed = boom_->known();
  if (placed)
    misuse_.hullAt(boom_->boom().pose().tip().translation());
  else
    misuse_.hullLost();
  misuse_.pressed(placed && boom_->contactKnown() ? std::make_optional(!boom_->state().press_force_lost)
                                                  : std::nullopt);
  for (std::size_t i = 0; i < result_.turn_ends; ++i) {
    const std::optional<HalfSinePulse>& pulse = result_.ends[i].pulse;
    const std::optional<bool> pressed = misuse_.blow(pulse ? std::make_optional(pulse->period) : std::nullopt);
    if (pressed.value_or(false)) result_.ends[i].struck = TurnEnd::Struck::kTool;
  }
}

}  // namespace hammer_loads
