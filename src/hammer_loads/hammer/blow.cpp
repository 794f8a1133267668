#include "hammer_loads/hammer/blow.h"

#include <cmath>

#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/blow_inertia.h"
#include "hammer_loads/linkage/link_motion.h"
#include "hammer_loads/linkage/mechanism.h"

namespace hammer_loads {
namespace {

double sign(double value) noexcept { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; }

/// J* = J + m_n l_N^2 [kg m2].
double strikingInertia(const StrikingRocker& rocker) noexcept {
  const HullPoint& n = rocker.rod_joint;
  return rocker.inertia_about_pivot + rocker.reduced_rod_mass * (n.x * n.x + n.z * n.z);
}

/// Impulse of the tool on a rocker; P1's w = -psi' is counter-clockwise in (x, z).
struct ToolImpulse {
  double x{}, z{};         ///< BY the tool ON the rocker [N s]
  double energy{};         ///< given to the tool along z [J]
  double friction_work{};  ///< [J]
};

/// Impulses and work of a blow with Coulomb friction, in both phases. While the rocker approaches, the moment about D
/// of an impulse I along z is (|x_K| + f |z_K|) I; in the rebound K slides back, and it is (|x_K| - f |z_K|) I. The
/// velocity of K is w (-z, x), and an impulse works with the mean of the velocities before and after its phase.
ToolImpulse toolImpulse(const StrikingRocker& rocker, double speed_before, double speed_after) noexcept {
  const HullPoint k = rocker.striking_point;
  const double w = -speed_before, friction_arm = rocker.friction * std::abs(k.z);
  const double sliding = sign(w * k.z), mean = -0.5 * (speed_before + speed_after);
  ToolImpulse tool;
  tool.z = strikingInertia(rocker) / (-k.x + friction_arm * sign(w)) * (speed_after - speed_before);  // P1 (4)
  tool.x = rocker.friction * tool.z * sliding;
  tool.energy = -tool.z * k.x * mean;
  tool.friction_work = tool.x * k.z * mean;
  const double rebound = speed_after * -sign(speed_before);
  if (!(rebound > 0.0) || !(friction_arm > 0.0)) return tool;
  // Deviates: P1 has the friction of the approach in the rebound as well.
  const double arm = std::abs(k.x), back = strikingInertia(rocker) * rebound / (arm - friction_arm);
  const double more = 2.0 * friction_arm / (arm + friction_arm) * back;  // in excess of that by the arm of the approach
  tool.z += more;
  tool.x += rocker.friction * sliding * (more - 2.0 * back);
  tool.energy -= 0.5 * arm * more * rebound;
  tool.friction_work += 0.5 * arm * more * rebound;
  return tool;
}

/// Blow on a tool that was met before the dead centre, but close to it. The rocker keeps its direction.
RockerBlow earlyBlow(const StrikingRocker& rocker, const BlowInertia& inertia, double speed, double factor) noexcept {
  RockerBlow blow;
  blow.rocker_speed_before = inertia.u_before * speed;
  blow.rocker_speed_after = factor * blow.rocker_speed_before;
  blow.restitution = kNaN;
  const HullPoint k = rocker.striking_point;
  const double lost = 0.5 * inertia.before() * (1.0 - factor * factor) * speed * speed;
  const double sum = blow.rocker_speed_before + blow.rocker_speed_after;  // < 0, as is k.x
  blow.tool_impulse_z = 2.0 * lost / ((k.x - rocker.friction * std::abs(k.z)) * sum);
  blow.tool_impulse_x = rocker.friction * blow.tool_impulse_z * sign(k.z);
  blow.friction_work = -0.5 * blow.tool_impulse_x * k.z * sum;
  blow.energy = lost - blow.friction_work;
  return blow;
}

}  // namespace

StrikingRocker strikingRocker(const Mechanism& mechanism, Level level) noexcept {
  const HammerParameters& p = mechanism.parameters();
  const double l2 = p.lengths.rod, l3 = p.lengths.rocker;
  StrikingRocker rocker;
  rocker.mass = p.rocker_mass;
  rocker.inertia_about_pivot = p.rocker_inertia_about_pivot;
  rocker.com = {-p.rocker_com_distance, 0.0};
  rocker.rod_joint = {-l3 * mechanism.cosComAngle(), -l3 * mechanism.sinComAngle()};
  rocker.reduced_rod_mass = level == Level::kLinkage ? mechanism.moments().rod_inertia / (l2 * l2) : 0.0;
  rocker.striking_point = {-p.striking_distance, p.striking_offset};
  rocker.friction = p.striking_friction;
  return rocker;
}

RockerBlow blowInSupport(const StrikingRocker& rocker, double speed_before, double speed_after) noexcept {
  const double change = speed_after - speed_before;  // P1's w-(1 + R)
  const ToolImpulse tool = toolImpulse(rocker, speed_before, speed_after);
  RockerBlow blow;
  blow.rocker_speed_before = speed_before;
  blow.rocker_speed_after = speed_after;
  blow.restitution = -speed_after / speed_before;
  blow.tool_impulse_x = tool.x;
  blow.tool_impulse_z = tool.z;
  blow.energy = tool.energy;
  blow.friction_work = tool.friction_work;
  // The hull gets the opposite of the support impulse on the rocker, P1 (8), (9).
  const double moment_x = rocker.mass * rocker.com.x + rocker.reduced_rod_mass * rocker.rod_joint.x;
  const double moment_z = rocker.mass * rocker.com.z + rocker.reduced_rod_mass * rocker.rod_joint.z;
  blow.support_impulse_x = blow.tool_impulse_x - change * moment_z;
  blow.support_impulse_z = blow.tool_impulse_z + change * moment_x;
  return blow;
}

HullPoint idealCentreOfMass(const StrikingRocker& rocker, double speed_before, double speed_after) noexcept {
  const ToolImpulse tool = toolImpulse(rocker, speed_before, speed_after);
  const double change = speed_after - speed_before;
  const double per_speed_z = tool.z / change, per_speed_x = tool.x / change;
  return {-(per_speed_z + rocker.reduced_rod_mass * rocker.rod_joint.x) / rocker.mass,
          (per_speed_x - rocker.reduced_rod_mass * rocker.rod_joint.z) / rocker.mass};
}

RockerBlow measuredBlow(const Mechanism& mechanism, Level level, const CrankBlow& crank) noexcept {
  const Level links = level == Level::kLinkage ? level : Level::kRocker;
  const BlowInertia inertia = blowInertia(mechanism, links, crank.drive_inertia);
  const StrikingRocker rocker = strikingRocker(mechanism, links);
  const auto blowOf = [&](double speed, double restitution) {
    const double before = inertia.u_before * speed;
    return blowInSupport(rocker, before, -restitution * before);
  };
  const double restitution = inertia.restitution(crank.factor);
  RockerBlow blow =
      crank.early ? earlyBlow(rocker, inertia, crank.speed, crank.factor) : blowOf(crank.speed, restitution);
  const double after = crank.factor * crank.speed;
  blow.crank_speed_before = crank.speed;
  blow.crank_speed_after = after;
  const LinkMomentum from = linkMomentum(mechanism, links, {0.0, Side::kBeforeBlow}, crank.speed);
  const LinkMomentum to = linkMomentum(mechanism, links, {0.0, Side::kAfterBlow}, after);
  const HullPoint k = rocker.striking_point;
  const double tool_moment = k.z * blow.tool_impulse_x - k.x * blow.tool_impulse_z;
  blow.support_impulse_x = blow.tool_impulse_x - (to.x - from.x);
  blow.support_impulse_z = blow.tool_impulse_z - (to.z - from.z);
  blow.support_impulse_y = tool_moment - (to.about_d - from.about_d);
  blow.drive_impulse_y = driveReaction(mechanism, links, crank.drive_inertia).torque(after - crank.speed, 0.0);
  // Deviations, each cause by a difference at its own size.
  const BlowInertia heavier = blowInertia(mechanism, links, crank.drive_inertia * (1.0 + crank.inertia_std));
  if (crank.early) {
    const auto change = [&](const BlowInertia& of, double speed, double factor) {
      return earlyBlow(rocker, of, speed, factor).energy - blow.energy;
    };
    blow.energy_std = std::hypot(change(inertia, crank.speed + crank.speed_std, crank.factor),
                                 change(inertia, crank.speed, crank.factor + crank.factor_std),
                                 change(heavier, crank.speed, crank.factor));
    return blow;
  }
  const double by_factor = inertia.restitutionPerFactor() * crank.factor_std;
  const double by_inertia = heavier.restitution(crank.factor) - restitution;
  blow.restitution_std = std::hypot(by_factor, by_inertia);
  const double energy_by_speed = blowOf(crank.speed + crank.speed_std, restitution).energy - blow.energy;
  const double energy_by_rebound = blowOf(crank.speed, restitution + blow.restitution_std).energy -
                                   blowOf(crank.speed, restitution - blow.restitution_std).energy;
  blow.energy_std = std::hypot(energy_by_speed, 0.5 * energy_by_rebound);
  return blow;
}

void voidImpossible(const Mechanism& mechanism, Level level, RockerBlow& blow) noexcept {
  constexpr double kDeviations = 2.0;  // contract of the message Blow
  const StrikingRocker rocker = strikingRocker(mechanism, level == Level::kLinkage ? level : Level::kRocker);
  const double most = 0.5 * strikingInertia(rocker) * blow.rocker_speed_before * blow.rocker_speed_before;
  const auto isOutside = [](double value, double deviation, double limit) {
    return value < -kDeviations * deviation || value > limit + kDeviations * deviation;
  };
  blow.impossible =
      isOutside(blow.restitution, blow.restitution_std, 1.0) || isOutside(blow.energy, blow.energy_std, most);
  if (blow.impossible || !(blow.restitution >= 0.0 && blow.restitution <= 1.0)) blow.restitution = kNaN;
  if (blow.impossible || !(blow.energy >= 0.0 && blow.energy <= most)) blow.energy = kNaN;
}

RockerBlow blowAtCrankSpeeds(const Mechanism& mechanism, Level level, double before, double after) noexcept {
  const double rocker_before = motion(mechanism.linkage(), {0.0, Side::kBeforeBlow}).u * before;
  const double rocker_after = motion(mechanism.linkage(), {0.0, Side::kAfterBlow}).u * after;
  RockerBlow blow = blowInSupport(strikingRocker(mechanism, level), rocker_before, rocker_after);
  blow.crank_speed_before = before;
  blow.crank_speed_after = after;
  return blow;
}

RockerBlow blowAtCrankSpeed(const Mechanism& mechanism, Level level, double crank_speed) noexcept {
  return blowAtCrankSpeeds(mechanism, level, crank_speed, crank_speed);
}

}  // namespace hammer_loads
