#include "hammer_loads/pipeline/rod_ring.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/consistency.h"
#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/linkage/blow_inertia.h"
#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/linkage/shaft_load.h"
#include "hammer_loads/util/ablation.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kLongest = 1e-3;         // [s] over which the lever is taken as constant
constexpr double kRestitutionStd = 0.05;  // error due to an elastic rod: 0.03 to 0.08, with worn pins to 0.14
// Prior: kRestitutionStd
constexpr double kMeanRestitution = 0.5,
                 kAnyRestitution = 0.29;  // mean and deviation of a restitution uniform from 0 to 1
constexpr double kOtherBlow = 0.08;       // scatter of a restitution from blow to blow
// Prior: kMeanRestitution, kAnyRestitution, kOtherBlow
constexpr double kPart = 1e-2;       // [rad], as kLongest
constexpr double kBallistic = 1e-2;  // [rad]: below it, the spring has no effect within a part
// Numerical: kLongest, kPart, kBallistic

/// Returns the root mean square of y'' over the unknown phase; without a phase y'' itself.
double acceleration(const Oscillator& rod, double y, double speed) noexcept {
  const double now = square(rod.square * y + 2.0 * rod.decay * speed), rest = rod.square - rod.decay * rod.decay;
  const double size = rest > 0.0 ? square(y) + square(speed + rod.decay * y) / rest : 0.0;
  return std::sqrt(0.5 * now + std::max(0.5 * now, 0.5 * square(rod.square) * size));
}

double fly(double rigid, double time, double& x, double& speed) noexcept {
  x += time * (speed - 0.5 * time * rigid);
  speed -= time * rigid;
  return std::abs(rigid);
}

/// Returns x of a rod that the motion of the rigid linkage presses against one side.
double settled(const RodSpring& spring, double lever, double inertia, double rigid) noexcept {
  return -std::copysign(0.5 * spring.play / std::abs(lever), rigid) -
         rigid * inertia / (spring.stiffness * square(lever));
}

/// Advances x and speed over a time. Returns the acceleration after it.
double moved(const RodSpring& spring, double lever, double inertia, double rigid, double time, double& x,
             double& speed) noexcept {
  const double by_lever = square(lever) / inertia, free = 0.5 * spring.play / std::abs(lever);
  const Oscillator rod{spring.stiffness * by_lever, 0.5 * spring.damping() * by_lever};
  if (rod.square * square(time) < square(kBallistic)) return fly(rigid, time, x, speed);
  if (std::abs(x) < free) {
    const double edge = std::copysign(free, speed), to_edge = (edge - x) / speed;
    if (!(to_edge < time)) return fly(rigid, time, x, speed);
    fly(rigid, to_edge, x, speed);
    x = edge;
    time -= to_edge;
  }
  const double rest_at = std::copysign(std::min(free, std::abs(x)), x) - rigid / rod.square;
  double y = x - rest_at;
  rod.move(time, y, speed);
  x = y + rest_at;
  return acceleration(rod, y, speed);
}

}  // namespace

Rods rodsOf(const RodPrior& prior) noexcept {
  const auto rod = [&](double damping, double play) {
    return RodSpring{prior.rod.stiffness, prior.rod.damping_ratio * std::exp(damping * prior.log_damping), play};
  };
  return {rod(-1.0, prior.rod.play), rod(1.0, prior.rod.play), rod(0.0, prior.rod.play + gate::kUsual * prior.play)};
}

RodRing::RodRing(const HullModel& model) noexcept : model_(&model) {
  const HammerParameters& p = model.mechanism().parameters();
  const RodPrior prior = priorOf(p.rod, p.rod_std);
  is_elastic_ = !HAMMER_LOADS_ABLATE(rod_ring) && prior.is_elastic;
  rods_ = rodsOf(prior);
}

void RodRing::begin(double displacement_rate) noexcept {
  moves_ = true;
  settles_ = false;
  acceleration_ = 0.0;
  states_.fill({0.0, displacement_rate});
}

void RodRing::strike(double speed_before, const BlowFactor& blow) noexcept {
  if (!(blow.drive_inertia > 0.0) || !(speed_before > 0.0)) return stop();
  const BlowInertia at = blowInertia(model_->mechanism(), model_->level(), blow.drive_inertia);
  double restitution = std::clamp(at.restitution(blow.mean), 0.0, 1.0), factor = blow.mean, deviation = kOtherBlow;
  if (unexplained_ && explained_) {  // the crank does not show this blow's restitution
    restitution = *explained_, factor = at.factor(restitution);
  } else {
    const double measured = std::isfinite(blow.deviation) ? at.restitutionPerFactor() * blow.deviation : 0.0;
    const double by_rod =
        lost_ && explained_ ? std::hypot(kOtherBlow, restitution - *explained_) : deviationOf(restitution);
    deviation = std::hypot(measured, by_rod);
  }
  const double rocker = -restitution * at.u_before * speed_before;  // rocker's speed as it leaves the tool
  const double of_restitution = deviation * at.u_before * speed_before;
  const double missing = rocker - at.u_after * factor * speed_before;
  struck_ = std::hypot(missing, of_restitution);
  begin(std::copysign(struck_, missing));
}

/// Moves the rods for a time with a constant lever. angle, speed, acceleration: of the crank in its middle.
void RodRing::moveThrough(const CrankAngle& angle, double speed, double acceleration, double time) noexcept {
  if (!(angle.offset > -RodEvidence::kPickedUp) || !(speed > 0.0)) return stop();
  const HammerParameters& p = model_->mechanism().parameters();
  const LinkMotion links = linkMotion(model_->mechanism().linkage(), angle);
  const double lever = p.lengths.rocker * links.sin_mu;
  const double rigid = links.rocker.du * square(speed) + links.rocker.u * acceleration;
  double sum = 0.0;
  for (std::size_t k = 0; k < rods_.size(); ++k) {
    if (HAMMER_LOADS_ABLATE(three_rods) && k < 2) continue;
    State& s = states_[k];
    if (settles_) s = {settled(rods_[k], lever, p.rocker_inertia_about_pivot, rigid), 0.0};
    sum += square(moved(rods_[k], lever, p.rocker_inertia_about_pivot, rigid, time, s.x, s.speed));
  }
  settles_ = false;
  acceleration_ = std::sqrt(sum / (HAMMER_LOADS_ABLATE(three_rods) ? 1.0 : static_cast<double>(rods_.size())));
}

void RodRing::move(const CrankStep& step, double from, double to) noexcept {
  if (!moves_ || !(to > from)) return;
  const int parts = partsOf(to - from, kLongest);
  const double time = (to - from) / parts;
  for (int i = 0; i < parts && moves_; ++i) {
    CrankEstimate crank = step.at(step.length());  // extrapolated back at constant speed, enough for the lever
    crank.position.slide(-crank.speed * (step.length() - from - (i + 0.5) * time));
    moveThrough(crank.position.angle, crank.speed, crank.acceleration, time);
  }
}

void RodRing::restart(const CrankFilter& tracker) noexcept {
  stop();
  const CrankEstimate now = tracker.estimate();
  const CrankAngle at = now.position.angle;
  if (!is_elastic_ || !(at.offset > 0.0) || !(at.offset < RodEvidence::kRungOut) || !(now.speed > kSlowCrank)) return;
  const auto loadAt = [&](double offset) {
    const LinkMotion links = linkMotion(model_->mechanism().linkage(), {offset, at.side});
    ShaftLoad load = shaftLoadLinkage(model_->mechanism(), links, {});
    load.inertia += tracker.driveInertia();
    return load;
  };
  const double energy = loadAt(at.offset).inertia * square(now.speed);  // twice the kinetic energy
  double from = 0.0;
  if (now.position.isMirrored()) {
    begin(0.0);
    from = -RodEvidence::kPickedUp;
  } else {
    strike(std::sqrt(energy / loadAt(0.0).inertia) / tracker.blowFactor().mean, tracker.blowFactor());
  }
  const int parts = partsOf(at.offset - from, kPart);
  const double part = (at.offset - from) / parts;
  for (int i = 0; i < parts && moves_; ++i) {
    const CrankAngle middle{from + (i + 0.5) * part, at.side};
    const ShaftLoad load = loadAt(middle.offset);
    const double speed = std::sqrt(energy / load.inertia);
    moveThrough(middle, speed, -load.half_inertia_slope * square(speed) / load.inertia, part / speed);
  }
}

void RodRing::approach(const CrankAngle& at) noexcept {
  if (approaches_ || !(at.offset < 0.0 && at.offset > -RodEvidence::kPickedUp)) return;
  begin(0.0);
  approaches_ = settles_ = true;
}

void RodRing::drive(const CrankStep& step, const CrankEstimate& crank) noexcept {
  const CrankAngle at = crank.position.angle;
  if (at.side != Side::kBeforeBlow || !(at.offset < 0.0) || !(crank.speed > 0.0)) return;
  const LinkMotion links = step.linksAt(at);
  const double lever = model_->mechanism().parameters().lengths.rocker * std::abs(links.sin_mu);
  const double free = 0.5 * rods_.back().play / lever;  // grows as 1/offset
  driven_ = std::max(driven_, -crank.speed * (links.rocker.u - free / at.offset));
}

void RodRing::release(const CrankStep::Passage& passage) noexcept {
  const double u_before = motion(model_->mechanism().linkage(), {0.0, Side::kBeforeBlow}).u;
  lacking_ = driven_ > 0.0 ? std::max(0.0, passage.speed_before + driven_ / u_before) : 0.0;
  driven_ = 0.0;
}

void RodRing::pass(const CrankStep::Passage& passage, const BlowFactor& blow) noexcept {
  if (passage.forward) approaches_ = false;
  if (!passage.strikes) return;
  release(passage);
  strike(passage.speed_before, blow);
}

void RodRing::follow(const CrankStep& step, const CrankFilter& tracker) noexcept {
  if (!is_elastic_) return;
  double from = 0.0;
  for (const CrankStep::Passage& passage : step) {
    move(step, from, passage.time);
    pass(passage, tracker.blowFactor());
    from = passage.time;
  }
  move(step, from, step.length());
  const CrankEstimate crank = tracker.estimate();
  approach(crank.position.angle);
  drive(step, crank);
}

void RodRing::setEvidence(const CrankFilter& filter, bool lost, std::optional<double> restitution) noexcept {
  const RodEvidence& evidence = filter.rodEvidence();
  share_ = std::sqrt(evidence.share(filter.readingDeviation()));
  released_ = std::sqrt(evidence.releasedShare(filter.readingDeviation()));
  unexplained_ = lost, lost_ = lost || evidence.isLost();
  explained_ = restitution;
}

double RodRing::deviationOf(double restitution) const noexcept {
  return lost_ ? std::hypot(kAnyRestitution, restitution - kMeanRestitution) : kRestitutionStd;
}

double RodRing::restitutionDeviation(double restitution) const noexcept {
  return is_elastic_ ? std::max(share_, released_) * deviationOf(restitution) : 0.0;
}

double RodRing::speed() const noexcept {
  double sum = 0.0;
  for (const State& state : states_) sum += square(state.speed);
  if (HAMMER_LOADS_ABLATE(three_rods)) sum = static_cast<double>(states_.size()) * square(states_.back().speed);
  return moves_ ? share_ * std::sqrt(sum / static_cast<double>(states_.size())) : 0.0;
}

Eigen::Matrix3d RodRing::covariance(const LinkMotion& links, double crank) const noexcept {
  const double relative = speed(),
               square_of_speed = std::hypot(2.0 * links.rocker.u * crank * relative, square(relative));
  const double along = model_->mechanism().rockerFirstMoment() * square_of_speed;
  const Eigen::Vector3d across = vectorOf(rockerWrench(model_->mechanism(), links, acceleration()));
  const Eigen::Vector3d inward = along * Eigen::Vector3d(links.rocker.cos_psi, -links.rocker.sin_psi, 0.0);
  return across * across.transpose() + inward * inward.transpose();
}

HullWrench rockerWrench(const Mechanism& mechanism, const LinkMotion& links, double acceleration) noexcept {
  const double force = mechanism.rockerFirstMoment() * acceleration;
  return {-force * links.rocker.sin_psi, -force * links.rocker.cos_psi,
          -mechanism.parameters().rocker_inertia_about_pivot * acceleration};
}

HullWrench rockerOnTool(const Mechanism& mechanism, const LinkMotion& links, Gravity gravity) noexcept {
  const double lift = gravity.x * links.rocker.sin_psi + gravity.z * links.rocker.cos_psi;  // per mass, by psi
  const double torque = std::max(0.0, -mechanism.rockerFirstMoment() * lift);
  return {0.0, torque / mechanism.parameters().striking_distance, torque};
}

}  // namespace hammer_loads
