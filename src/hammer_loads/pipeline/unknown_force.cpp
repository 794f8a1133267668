#include "hammer_loads/pipeline/unknown_force.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/linkage/mechanism.h"
#include "hammer_loads/pipeline/rod_ring.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kContacts = 0.012;     // root mean square of the contacts' force over its greatest
constexpr double kContactsLever = 0.5;  // in parts of l3
constexpr double kHidden = 0.05;        // part of the file's clearance that is hidden in the readings
constexpr double kOfDamping = 0.4;      // part of the moment, per unit of the damping ratio
constexpr double kLasts = 0.1;          // [s]
constexpr double kFrictionPins = 2.0;   // at both ends of the rocker
constexpr double kHeld = 0.02;          // [s] for which friction affects the rod
// Prior: kContacts, kContactsLever, kHidden, kOfDamping, kLasts, kFrictionPins, kHeld
// (WornMachine.IsCoveredWithFrictionAndClearance)
constexpr double kLeastLever = 0.01;  // part of l3: below it the rod's force does not follow from its moment
// Numerical: kLeastLever

}  // namespace

UnknownForce::UnknownForce(const Mechanism& mechanism) noexcept : mechanism_(&mechanism) {
  const RodSpring &rod = mechanism.parameters().rod, &deviation = mechanism.parameters().rod_std;
  const RodPrior prior = priorOf(rod, deviation);
  if (!prior.is_elastic) return;
  clearance_ = given_clearance_ = std::hypot(rod.play, deviation.play);
  friction_radius_ = given_friction_radius_ = std::hypot(rod.friction_radius, deviation.friction_radius);
  damping_ = deviation.damping_ratio;
  stiffness_ = prior.rod.stiffness;
}

void UnknownForce::follow(double step, bool passed, bool waits) noexcept {
  passed_ = passed_ || passed;
  const bool struck = passed_ && !waits;
  if (struck) last_ = now_, now_ = {}, passed_ = false;
  since_ = struck ? 0.0 : since_ + step;
  held_ *= std::exp(-step / kHeld);
}

void UnknownForce::observe(const std::optional<IdentifiedPins>& pins) noexcept {
  friction_radius_ = pins ? pins->friction_radius_std : given_friction_radius_;
  clearance_ = pins ? std::hypot(pins->clearance, kHidden * given_clearance_) : given_clearance_;
}

void UnknownForce::vibrates(const LinkMotion& links, double vibration) noexcept {
  const HammerParameters& p = mechanism_->parameters();
  const double moment = p.rocker_inertia_about_pivot * std::abs(vibration);
  const double force = moment / (p.lengths.rocker * std::max(kLeastLever, std::abs(links.sin_mu)));
  held_ = std::max(force, held_);
  now_ = {std::max(now_.moment, moment), std::max(now_.force, force)};
}

double UnknownForce::contacts() const noexcept {
  return kContacts * std::sqrt(2.0 * stiffness_ * clearance_ * greatest().force);
}

UnknownForce::Errors UnknownForce::errors(const LinkMotion& links) const noexcept {
  const HammerParameters& p = mechanism_->parameters();
  const double lasts = std::exp(-square(since_ / kLasts)), contacts = lasts * this->contacts();
  const double on_rocker[] = {kContactsLever * p.lengths.rocker * contacts, kFrictionPins * friction_radius_ * held_,
                              kOfDamping * damping_ * lasts * greatest().moment};
  const Eigen::Vector3d by_moment = vectorOf(rockerWrench(*mechanism_, links, 1.0 / p.rocker_inertia_about_pivot));
  Errors errors{by_moment.cwiseAbs2().replicate<1, kSources>(), {}};
  double moment = 0.0;
  for (Eigen::Index i = 0; i < kSources; ++i) {
    errors.squares.col(i) *= square(on_rocker[i]);
    moment += square(on_rocker[i]);
  }
  errors.squares.col(kClearance).head<2>().array() += square(contacts);
  errors.covariance = moment * by_moment * by_moment.transpose();
  errors.covariance.diagonal().head<2>().array() += square(contacts);
  return errors;
}

/// Returns the force just after a blow. Friction is that at the rod's greatest force.
UnknownForce::Largest UnknownForce::largest() const noexcept {
  constexpr const char* kNames[kSources] = {"the pins' clearance", "the pins' friction", "the rod's damping"};
  const HammerParameters& p = mechanism_->parameters();
  const double by_moment = mechanism_->rockerFirstMoment() / p.rocker_inertia_about_pivot;
  const double forces[kSources] = {contacts() * std::hypot(1.0, kContactsLever * p.lengths.rocker * by_moment),
                                   kFrictionPins * friction_radius_ * greatest().force * by_moment,
                                   kOfDamping * damping_ * greatest().moment * by_moment};
  const auto i = std::max_element(forces, forces + kSources) - forces;
  return {std::hypot(forces[kClearance], forces[kFriction], forces[kDamping]), kNames[i], kKeys[i]};
}

}  // namespace hammer_loads
