#include "hammer_loads/hammer/choose_level.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr int kPoints = 2000;  // of the turn; the pulse is some 200 of them long

/// A turn from blow to blow under constant torque, at level linkage and without weight.
std::vector<CrankMotion> workingTurn(const Mechanism& mechanism, double turn_rate) {
  const double drive = mechanism.parameters().drive_inertia;
  const auto load = [&](CrankAngle angle) { return shaftLoad(mechanism, Level::kLinkage, angle, {}); };
  const double after = drive + load({0.0, Side::kAfterBlow}).inertia;
  const double lost = load({0.0, Side::kBeforeBlow}).inertia - load({0.0, Side::kAfterBlow}).inertia;
  std::vector<CrankMotion> turn;
  double period = 0.0;  // at speed 1 at the blow
  for (int i = 0; i < kPoints; ++i) {
    const double part = (i + 0.5) / kPoints;
    const CrankAngle angle = CrankAngle::fromAngle(kTwoPi * part);
    const ShaftLoad at = load(angle);
    const double inertia = drive + at.inertia;
    const double speed = std::sqrt((after + lost * part) / inertia);  // kinetic energy grows in proportion to the angle
    turn.push_back({angle, speed, (0.5 * lost / kTwoPi - at.half_inertia_slope * speed * speed) / inertia});
    period += kTwoPi / kPoints / speed;
  }
  const double scale = period * turn_rate;
  for (CrankMotion& point : turn) point.speed *= scale, point.acceleration *= scale * scale;
  return turn;
}

double largestError(const HullModel& model, const HullModel& rich, const std::vector<CrankMotion>& turn,
                    Gravity gravity) {
  double force = 0.0, moment = 0.0, force_error = 0.0, moment_error = 0.0;
  for (const CrankMotion& point : turn) {
    const HullWrench actual = hullWrench(model, point, gravity), reference = hullWrench(rich, point, gravity);
    force = std::max({force, std::abs(reference.force_x), std::abs(reference.force_z)});
    moment = std::max(moment, std::abs(reference.torque_y));
    force_error = std::max({force_error, std::abs(actual.force_x - reference.force_x), std::abs(actual.force_z - reference.force_z)});
    moment_error = std::max(moment_error, std::abs(actual.torque_y - reference.torque_y));
  }
  return std::max(force_error / force, moment_error / moment);
}

}  // namespace

LevelChoice chooseLevel(const Mechanism& mechanism, double tolerance, double turn_rate, double g) {
  const std::vector<CrankMotion> turn = workingTurn(mechanism, turn_rate);
  const HullModel rich(mechanism, Level::kLinkage);
  LevelChoice choice{Level::kLinkage, tolerance, {}};
  const std::array<Level, 2> poorer{Level::kPulse, Level::kRocker};
  for (std::size_t i = poorer.size(); i-- > 0;) {
    choice.error[i] = largestError(HullModel(mechanism, poorer[i]), rich, turn, {0.0, -g});
    if (choice.error[i] <= tolerance) choice.level = poorer[i];
  }
  return choice;
}

std::string describe(const LevelChoice& choice) {
  const char* names[] = {"pulse", "rocker", "linkage"};
  return format(
      "level auto: %s is the cheapest within tolerance %.3g %% of the peak; error over a working turn: "
      "pulse %.3g %%, rocker %.3g %%, linkage 0 %%",
      names[static_cast<std::size_t>(choice.level)], 100.0 * choice.tolerance, 100.0 * choice.error[0],
      100.0 * choice.error[1]);
}

}  // namespace hammer_loads
