#include "hammer_loads/pipeline/elastic_follower.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_dynamics.h"
#include "hammer_loads/estimation/gates.h"
#include "hammer_loads/estimation/look_back.h"
#include "hammer_loads/hammer/hull_wrench.h"
#include "hammer_loads/linkage/blow_inertia.h"
#include "hammer_loads/util/ablation.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kFrom = -0.30;                  // beginning of the elastic model [rad]
constexpr double kTo = 2.2, kRungOutTime = 0.3;  // [rad], [s] after the blow: by then no rod vibrates
// Numerical: kTo, kRungOutTime
constexpr double kEvidenceGain = 0.2, kGivenUp = 20.0;  // for logarithms of likelihoods, per blow
constexpr std::int64_t kOthersTurn = 4;                 // [blows]
// Numerical: kOthersTurn
constexpr double kContact = 5e-4;  // [s]

/// Returns true if the rod no longer vibrates. After a blow with a small restitution it brakes the crank to less than
/// kSlowCrank. A rocker that was never struck is contradicted long before.
bool isOver(const RodFilter& rod) noexcept {
  const TwoBodyState& s = rod.motion().state;
  return s.angle.offset > kTo || rod.sinceBlow() > kRungOutTime || !(s.speed > (rod.hasStruck() ? 0.0 : kSlowCrank));
}

}  // namespace

ElasticFollower::ElasticFollower(const HullModel& model, Level level) noexcept
    : model_(&model),
      wanted_(level == Level::kElastic &&
              priorOf(model.mechanism().parameters().rod, model.mechanism().parameters().rod_std).is_elastic),
      filters_{RodFilter(model.mechanism(), RodFilter::Pins::kTight),
               RodFilter(model.mechanism(), RodFilter::Pins::kPlay)} {}

bool ElasticFollower::mayBegin(const CrankFollower& crank, const CrankFilter& filter) const noexcept {
  const CrankPosition& at = crank.estimate().position;
  return at.angle.side == Side::kBeforeBlow && at.angle.offset > kFrom && crank.estimate().speed > kSlowCrank &&
         filter.hasSpeed() && filter.driveInertia() > 0.0 && filter.isPlausible() && !filter.isUncertain() &&
         filter.readingDeviation() < RodEvidence::kCoarsest;
}

const char* ElasticFollower::whyNotUsed() const noexcept {
  if (!wanted_) return "the connecting rod is rigid in the hammer file";
  if (too_coarse_) return "readings are too coarse or jitter too much to show the connecting rod";
  if (blows_ == 0) return "no blow has been followed yet";
  return lost_ ? "readings contradict the model of an elastic connecting rod"
               : "readings fit a rigid connecting rod as well";
}

void ElasticFollower::pause() noexcept {
  runs_ = false;
  for (RodFilter& filter : filters_) filter.abandon();
}

/// Returns false on each fourth blow, since pins wear, and wherever the likelier filter contradicts the readings.
bool ElasticFollower::runsAlone(std::int64_t blow) const noexcept {
  return best_ != nullptr && best_->isProven() && blow % kOthersTurn != 0;
}

void ElasticFollower::begin(const CrankFollower& crank, const CrankFilter& filter, Gravity gravity) noexcept {
  runs_ = true;
  blow_ = crank.estimate().position.blow;
  rigid_fit_ = 0.0;
  alone_ = runsAlone(blow_);
  for (RodFilter& rod : filters_)
    if ((!alone_ || &rod == best_) && !(HAMMER_LOADS_ABLATE(tight_pins) && &rod == filters_.data()))
      rod.begin(filter, gravity);
}

void ElasticFollower::followRods(const CrankFollower& crank, Gravity gravity) noexcept {
  const CrankFilter& filter = crank.tracker();
  too_coarse_ = !(filter.readingDeviation() < RodEvidence::kCoarsest);
  if (!runs_) {
    if (mayBegin(crank, filter)) begin(crank, filter, gravity);
    return;
  }
  const double dt = length_ = crank.step().length();
  if (!(dt < look_back::kHeld)) return pause();
  rigid_fit_ += filter.angleFit();
  late_ = filter.constantErrors().consideredDeviation(ConstantErrors::kLatency);
  for (RodFilter& rod : filters_) {
    if (!rod.isRunning()) continue;
    rod.move(dt, filter.walks(), gravity);
    if (!rod.update(filter.sample()) || isOver(rod)) rod.learn();
  }
  if (std::none_of(filters_.begin(), filters_.end(), [](const RodFilter& rod) { return rod.isRunning(); })) judge();
}

/// Returns the filter with clearance if that is evident or if tight pins fail: they cannot imitate its impacts.
const RodFilter& ElasticFollower::likelier() const noexcept {
  const RodFilter &tight = filters_[0], &play = filters_[1];
  if (!play.isProven()) return tight;
  const double variance = square(play.deviation(RodFilter::kPlay));
  return !tight.isProven() || exceeds(play.motion().rod.play, variance, gate::kImpossible) ? play : tight;
}

/// Judges the rod after a blow. Level linkage applies to a rod stiffer than the sample rate can show.
void ElasticFollower::judge() noexcept {
  runs_ = false;
  ++blows_;
  lost_ = alone_ ? !best_->isProven() : !filters_[0].isProven() && !filters_[1].isProven();
  if (alone_ && lost_) return;  // the other filter runs at the next blow
  const RodFilter& rod = alone_ ? *best_ : likelier();
  const double gain = rod.isProven() ? std::clamp(rod.fit() - rigid_fit_, -kGivenUp, kGivenUp) : -kGivenUp;
  evidence_ += kEvidenceGain * (gain - evidence_);
  best_ = evidence_ > (best_ == nullptr ? odds::kLikely : 0.0) ? &rod : nullptr;
  if (!rod.isProven()) return;
  restitution_ = rod.motion().restitution;
  pins_ = {rod.motion().rod.play, rod.frictionDeviation()};
}

CrankEstimate ElasticFollower::crankOf(const RodMotion& m) const noexcept {
  const LinkMotion links = filter().bodies().links(m.state.angle);
  return {
      {blow_, m.state.angle}, m.state.speed, filter().bodies().rigidAcceleration(filter().drive(m), m.state, links)};
}

LoadImpulse ElasticFollower::momentum(const TwoBodyState& s, const LinkMotion& rigid,
                                      const DriveReaction& drive) const noexcept {
  const LinkMotion links = withRocker(rigid, s.displacement);
  const HullWrench minus = hullWrenchOf(model_->mechanism(), links, filter().bodies().linkSpeeds(s, links), Gravity{});
  const double drive_y = drive.by_crank * s.speed;
  return {-1.0 * minus + HullWrench{0.0, 0.0, drive_y}, drive_y};
}

ElasticFollower::Impulse ElasticFollower::impulse(const DriveReaction& drive, double from, double to) const noexcept {
  const auto lost = [&](const TwoBodyState& a, const TwoBodyState& b) {
    const LoadImpulse before = momentumOf(a, drive), after = momentumOf(b, drive);
    return LoadImpulse{before.all + -1.0 * after.all, before.drive_y - after.drive_y};
  };
  const TwoBodyState begin = motionAt(from).state, end = motionAt(to).state;
  Impulse result{lost(begin, end), {}};
  const std::optional<TwoBodies::Blow>& blow = filter().blowOfStep();
  if (!blow || begin.angle.side == end.angle.side) return result;
  const LoadImpulse jump = lost(blow->before, blow->after);
  result.motion = {result.motion.all + -1.0 * jump.all, result.motion.drive_y - jump.drive_y};
  const double restitution = filter().deviation(RodFilter::kRestitution);
  result.deviation = wrenchOf(restitution / (1.0 + filter().motion().restitution) * vectorOf(jump.all).cwiseAbs());
  return result;
}

HullWrench ElasticFollower::momentumDeviation(const DriveReaction& drive) const noexcept {
  const RodFilter::Belief::Matrix errors = filter().errors();
  const Eigen::Vector3d here = vectorOf(momentumOf(filter().motion().state, drive).all);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < RodFilter::kRestitution; ++i)
    squares += (vectorOf(momentumOf(filter().displaced(errors.col(i)).state, drive).all) - here).cwiseAbs2();
  return wrenchOf(squares.cwiseSqrt());
}

double ElasticFollower::strikingSpeed() const noexcept {
  const double inertia = filter().drive(filter().motion()).inertia;
  return filter().rockerBefore() / blowInertia(model_->mechanism(), model_->level(), inertia).u_before;
}

std::optional<CrankBlow> ElasticFollower::blow() const noexcept {
  if (!runs() || !filter().hasStruck()) return std::nullopt;
  const RodMotion& m = filter().motion();
  CrankBlow blow;
  blow.drive_inertia = filter().drive(m).inertia;
  const BlowInertia inertia = blowInertia(model_->mechanism(), model_->level(), blow.drive_inertia);
  blow.speed = strikingSpeed();
  blow.speed_std = filter().deviation(RodFilter::kSpeed);
  blow.factor = inertia.factor(m.restitution);
  blow.factor_std = filter().deviation(RodFilter::kRestitution) / inertia.restitutionPerFactor();
  return blow;
}

bool ElasticFollower::isBesideBlow() const noexcept {
  return filter().hasStruck() ? filter().sinceBlow() < kContact : mayTouch(filter().motion());
}

bool ElasticFollower::isBesideBlowAt(double time) const noexcept {
  const RodMotion there = motionAt(time);
  if (there.state.angle.side == Side::kBeforeBlow) return mayTouch(there);
  return filter().blowOfStep() || filter().sinceBlow() - (length_ - time) < kContact;
}

bool ElasticFollower::mayTouch(const RodMotion& m) const noexcept {
  const LinkMotion links = filter().bodies().links(m.state.angle);
  const double way = links.rocker.sin_psi + m.state.displacement - m.place;
  const double speed = -(links.rocker.u * m.state.speed + m.state.displacement_rate);
  const double of_angle = speed / m.state.speed * filter().deviation(RodFilter::kAngle);
  // The place is that of the middle of a contact, which has begun before it.
  return way < 0.5 * kContact * speed + gate::kUsual * std::hypot(of_angle, filter().deviation(RodFilter::kPlace));
}

}  // namespace hammer_loads
