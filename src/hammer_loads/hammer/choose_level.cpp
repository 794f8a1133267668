#include "hammer_loads/hammer/choose_level.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "hammer_loads/hammer/hull_model.h"
#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/linkage/two_bodies.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr int kPoints = 2000;        // points of a revolution; the pulse takes some 200 of them
constexpr double kRounding = 1e-12;  // smallest relative difference of a load that is not rounding

/// From blow to blow under constant torque, at level linkage and without weight.
struct WorkingTurn {
  std::vector<CrankMotion> points;
  double speed_after{};  ///< at the blow [rad/s]
  double torque{};       ///< [N m]
};

WorkingTurn workingTurn(const Mechanism& mechanism, double turn_rate) {
  const double drive = mechanism.parameters().drive_inertia;
  const auto load = [&](CrankAngle angle) { return shaftLoad(mechanism, Level::kLinkage, angle, {}); };
  const double after = drive + load({0.0, Side::kAfterBlow}).inertia;
  const double lost = load({0.0, Side::kBeforeBlow}).inertia - load({0.0, Side::kAfterBlow}).inertia;
  WorkingTurn turn{{}, 1.0, 0.5 * lost / kTwoPi};  // at first with speed 1 at the blow
  double period = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double part = (i + 0.5) / kPoints;
    const CrankAngle angle = CrankAngle::fromAngle(kTwoPi * part);
    const ShaftLoad at = load(angle);
    const double inertia = drive + at.inertia;
    const double speed = std::sqrt((after + lost * part) / inertia);  // kinetic energy grows in proportion to the angle
    turn.points.push_back({angle, speed, (turn.torque - at.half_inertia_slope * speed * speed) / inertia});
    period += kTwoPi / kPoints / speed;
  }
  const double scale = period * turn_rate;
  for (CrankMotion& point : turn.points) point.speed *= scale, point.acceleration *= scale * scale;
  turn.speed_after = scale, turn.torque *= scale * scale;
  return turn;
}

/// Difference of the loads on the hull (force x, force z, moment) between the elastic and a rigid connecting rod at the
/// same angle and speed of the crank.
Eigen::Vector3d besideRigid(const Mechanism& mechanism, const TwoBodies& bodies, const RodSpring& rod,
                            const TwoBodyDrive& drive, const TwoBodyState& at) {
  const LinkMotion links = bodies.links(at.angle);
  const TwoBodyAccelerations a = bodies.accelerations(rod, drive, at, links);
  const CrankMotion rigid{at.angle, at.speed, bodies.rigidAcceleration(drive, at, links)};
  return vectorOf(hullWrenchOf(mechanism, bodies, at, a, links, drive.gravity)) -
         vectorOf(hullWrenchLinkage(mechanism, links, rigid, drive.gravity));
}

/// Squares of besideRigid(), summed over the points of a revolution. The vibration starts with a blow that stops the
/// rocker at the tool and is followed for a quarter of a revolution. Each square is that of a mean over `interval` [s].
/// The first millisecond is left out: it belongs to the blow, and even an almost rigid rod shows all of it.
Eigen::Vector3d ofRod(const Mechanism& mechanism, const RodSpring& rod, const WorkingTurn& turn, Gravity gravity,
                      double interval) {
  constexpr double kStep = 2e-5, kOfBlow = 1e-3;  // [s]
  // Numerical: kStep, kOfBlow
  const TwoBodies bodies(mechanism);
  const TwoBodyDrive drive{mechanism.parameters().drive_inertia, turn.torque, gravity};
  TwoBodyState state{{0.0, Side::kAfterBlow}, turn.speed_after, 0.0, 0.0};
  state.displacement_rate = -bodies.links(state.angle).rocker.u * turn.speed_after;
  const int steps = std::max(1, static_cast<int>(std::lround(interval / kStep)));
  double time = 0.0;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  const auto rings = [&] { return state.angle.offset < 0.25 * kTwoPi && state.speed > 0.0; };
  while (rings()) {
    const double from = state.angle.offset;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int i = 0; i < steps && rings(); ++i, time += kStep) {
      if (time > kOfBlow) mean += besideRigid(mechanism, bodies, rod, drive, state) / steps;
      bodies.move(rod, drive, kStep, state);
    }
    squares += (state.angle.offset - from) / kTwoPi * kPoints * mean.cwiseAbs2();
  }
  return squares;
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
               .squaredNorm()
               .cast<double>();
  return sum;
}

}  // namespace

LevelChoice chooseLevel(const Mechanism& mechanism, double tolerance, double turn_rate, double g, double interval) {
  const WorkingTurn turn = workingTurn(mechanism, turn_rate);
  const HullModel rich(mechanism, Level::kLinkage);
  const Gravity gravity{0.0, -g};
  const Eigen::Vector3d open = openVariance(rich, turn.points, HullMotion{gravity});
  std::vector<Eigen::Vector3d> references;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  for (const CrankMotion& point : turn.points) {
    references.push_back(loadOf(rich, point, gravity));
    size += references.back().cwiseAbs2();
  }
  const HammerParameters& p = mechanism.parameters();
  const RodPrior rod = priorOf(p.rod, p.rod_std);
  Eigen::Vector3d of_rod = Eigen::Vector3d::Zero();
  if (rod.is_elastic) of_rod = ofRod(mechanism, rod.rod, turn, gravity, interval);
  LevelChoice choice{rod.is_elastic ? Level::kElastic : Level::kLinkage, tolerance, rod.is_elastic, {}};
  for (std::size_t i = choice.difference.size(); i-- > 0;) {
    const HullModel model(mechanism, static_cast<Level>(i));
    Eigen::Vector3d squares = of_rod;
    for (std::size_t k = 0; k < references.size(); ++k)
      squares += (loadOf(model, turn.points[k], gravity) - references[k]).cwiseAbs2();
    for (int k = 0; k < 3; ++k) {
      if (squares[k] <= kRounding * kRounding * size[k]) continue;
      choice.difference[i] = std::max(choice.difference[i], std::sqrt(squares[k] / open[k]));
    }
    if (choice.difference[i] <= tolerance) choice.level = static_cast<Level>(i);
  }
  return choice;
}

std::string describe(const LevelChoice& choice) {
  const char* names[] = {"pulse", "rocker", "linkage", "elastic"};
  const auto name = [&](Level level) { return names[static_cast<std::size_t>(level)]; };
  return format(
      "level auto: %s is the cheapest whose difference to %s is within %.3g of what the hammer file leaves open; "
      "over a working turn: pulse %.3g, rocker %.3g, linkage %.3g%s",
      name(choice.level), name(choice.rod_is_elastic ? Level::kElastic : Level::kLinkage), choice.tolerance,
      choice.difference[0], choice.difference[1], choice.difference[2], choice.rod_is_elastic ? ", elastic 0" : "");
}

}  // namespace hammer_loads
