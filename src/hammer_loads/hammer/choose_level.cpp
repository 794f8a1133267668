#include "hammer_loads/hammer/choose_level.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hammer_loads/hammer/wrench_columns.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr int kPoints = 2000;        // of the turn; the pulse is some 200 of them long
constexpr double kRounding = 1e-12;  // of a load: no difference

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

Eigen::Vector3d loadOf(const HullModel& model, const CrankMotion& point, Gravity gravity) {
  return vectorOf(hullWrench(model, point, gravity));
}

/// Variances of level linkage by the hammer's constants, sums over the turn.
Eigen::Vector3d openVariance(const HullModel& rich, const std::vector<CrankMotion>& turn, const HullMotion& hull) {
  const WrenchColumns columns(rich);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CrankMotion& point : turn)
    sum += columns.wrench(rich.mechanism().parameters().drive_inertia, linksAt(rich, point.angle), point, hull)
               .rowwise()
               .squaredNorm();
  return sum;
}

}  // namespace

LevelChoice chooseLevel(const Mechanism& mechanism, double tolerance, double turn_rate, double g) {
  const std::vector<CrankMotion> turn = workingTurn(mechanism, turn_rate);
  const HullModel rich(mechanism, Level::kLinkage);
  const Gravity gravity{0.0, -g};
  const Eigen::Vector3d open = openVariance(rich, turn, HullMotion{gravity});
  std::vector<Eigen::Vector3d> references;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  for (const CrankMotion& point : turn) {
    references.push_back(loadOf(rich, point, gravity));
    size += references.back().cwiseAbs2();
  }
  LevelChoice choice{Level::kLinkage, tolerance, {}};
  const std::array<Level, 2> poorer{Level::kPulse, Level::kRocker};
  for (std::size_t i = poorer.size(); i-- > 0;) {
    const HullModel model(mechanism, poorer[i]);
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    for (std::size_t p = 0; p < turn.size(); ++p)
      squares += (loadOf(model, turn[p], gravity) - references[p]).cwiseAbs2();
    for (int k = 0; k < 3; ++k) {
      if (squares[k] <= kRounding * kRounding * size[k]) continue;
      choice.difference[i] = std::max(choice.difference[i], std::sqrt(squares[k] / open[k]));
    }
    if (choice.difference[i] <= tolerance) choice.level = poorer[i];
  }
  return choice;
}

std::string describe(const LevelChoice& choice) {
  const char* names[] = {"pulse", "rocker", "linkage"};
  return format(
      "level auto: %s is the cheapest whose difference to linkage is within %.3g of what the hammer file leaves open; "
      "over a working turn: pulse %.3g, rocker %.3g, linkage 0",
      names[static_cast<std::size_t>(choice.level)], choice.tolerance, choice.difference[0], choice.difference[1]);
}

}  // namespace hammer_loads
