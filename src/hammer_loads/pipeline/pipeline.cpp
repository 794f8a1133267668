#include "hammer_loads/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/pipeline/hull_deviation.h"
#include "hammer_loads/pipeline/step_impulse.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

// Limits beyond which nothing is published, relative to the nominal revolution at constant speed. Its peak is some four
// times that of a hammer at work.
constexpr double kMostForce = 3.0, kMostForceUnproven = 0.5;  // once readings and model agree; before that
constexpr double kMostSpeedUnproven = 2.0;                    // then the crank may be in degrees
constexpr double kUncertain = 5.0;   // times withhold_above: half of the peak; a less certain load is useless
constexpr double kInertiaOff = 0.9;  // logarithm of drive inertia over the given one; a wrong zero changes it more
// Limit: kMostForce, kMostForceUnproven, kMostSpeedUnproven, kUncertain
constexpr std::size_t kMostOutputs = 100'000;  // of one sample, without allocation: 10 kHz over a gap of 10 s
// Numerical: kMostOutputs

/// Returns the largest component of the force over a revolution [N].
double peakAtConstantSpeed(const Mechanism& mechanism, Level level, double speed) noexcept {
  constexpr int kPoints = 72;  // Numerical: kPoints
  const HullModel model(mechanism, level == Level::kPulse ? Level::kRocker : level);
  double force = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const CrankAngle angle = CrankAngle::fromOffset(CrankAngle::wrapToPi(kTwoPi * i / kPoints - 1e-6));
    const HullWrench w = hullWrench(model, CrankMotion{angle, speed, 0.0}, HullMotion{});
    force = std::max({force, std::abs(w.force_x), std::abs(w.force_z)});
  }
  return force;
}

}  // namespace

Pipeline::Pipeline(const Mechanism& mechanism, const PipelineSettings& settings, const std::optional<Boom>& boom,
                   const SampleCounts& counts)
    : mechanism_(mechanism),
      settings_(settings),
      model_(mechanism_, settings.level),
      columns_(model_),
      displaced_links_(model_),
      crank_(model_, settings_),
      trust_(settings_.crank_sensor),
      zero_(ShaftModel(mechanism_, model_.level()), mechanism_.parameters().drive_inertia),
      hull_(mechanism_.parameters(), settings_, boom),
      rod_(model_),
      unknown_(mechanism_),
      elastic_(model_, settings_.level),
      turn_(model_, columns_, crank_.step(), crank_.tracker(), rod_, elastic_, hull_.prior()),
      sampler_(model_, columns_, crank_.step(), crank_.tracker(), elastic_, settings_),
      near_blow_(settings_.near_blow),
      nominal_force_(
          pulseAtConstantSpeed(mechanism_, model_.level(), kTwoPi * settings_.turn_rate, {}).pulse.amplitude),
      peak_at_speed_(peakAtConstantSpeed(mechanism_, model_.level(), kTwoPi * settings_.turn_rate)),
      counts_(counts) {
  columns_.tabulate();
  if (boom) boom_.emplace(*boom, settings_, mechanism.parameters().striking_distance);
  result_.outputs.reserve(std::min(sampler_.mostOutputs(), kMostOutputs));
}

const SampleResult& Pipeline::crankJoint(StampNs stamp, const std::vector<std::string>& names,
                                         const std::vector<double>& positions,
                                         const std::vector<double>& velocities) noexcept {
  result_.stamp = result_.sample_stamp = stamp;
  result_.turn_ends = 0;
  result_.outputs.clear();
  const auto found = std::find(names.begin(), names.end(), settings_.crank_joint);
  if (found == names.end()) return refuse(Refusal::kMissingJoint);
  const auto i = static_cast<std::size_t>(found - names.begin());
  if (i >= positions.size() || (!velocities.empty() && i >= velocities.size())) return refuse(Refusal::kShortArray);
  return crankSample(stamp, {positions[i], velocities.empty() ? std::nullopt : std::make_optional(velocities[i])});
}

const SampleResult& Pipeline::refuse(Refusal refusal) noexcept {
  result_.refusal = refusal;
  result_.boom = nullptr;
  ++counts_.refused[static_cast<std::size_t>(refusal)];
  return result_;
}

/// Ends a sample that the crank has used and the outputs have not. The outputs continue from the next sample.
const SampleResult& Pipeline::withhold(Refusal refusal) noexcept {
  const bool continues = refusal == Refusal::kUnsettled && crank_.step().known();
  advanceBoom(continues ? wrenchHistory(model_, crank_.step()) : WrenchHistory{});
  sampler_.forget();
  turn_.withheld();
  return refuse(refusal);
}

const SampleResult& Pipeline::crankSample(StampNs header, const CrankSample& measured) noexcept {
  result_.stamp = result_.sample_stamp = header;
  result_.turn_ends = 0;
  result_.outputs.clear();
  result_.refusal.reset();
  if (const auto refusal = crank_.judge(header, measured)) {
    if (isOfUnit(*refusal)) turn_.discard();
    return refuse(*refusal);
  }
  result_.stamp = crank_.stamp();
  const CrankFollower::Outcome outcome = crank_.update(hull_.predict(result_.stamp));
  if (outcome == CrankFollower::Outcome::kRefused) return refuse(Refusal::kImplausible);
  follow(outcome);
  crank_.accept();
  if (const auto refusal = whyWithheld()) return withhold(*refusal);

  // With a followed elastic rod, crank, links, deviation and vibration are those of its spring.
  if (elastic_.runs()) result_.crank = elastic_.crank();
  const CrankMotion motion = motionOf(result_.crank);
  const LinksForGradient links(model_, elastic_.runs() ? linksAt(model_, motion.angle) : crank_.step().links());
  settled_ = isPlausible(hullWrench(model_, links.here.links, motion, hull_.motion().motion));
  if (!settled_) return withhold(Refusal::kImplausible);
  const DriveReaction drive = driveReaction(model_, crank_.tracker().driveInertia());
  const ElasticFollower::RodLoads rod = computeDeviations(links, drive);
  result_.boom = nullptr;
  if (boom_) followBoom(links, drive);
  hullMovedAtBlow();
  hull_.vibrates(result_.boom != nullptr ? &*boom_ : nullptr);
  fill(links, drive, rod);
  sampler_.sample(links, result_, result_.outputs);
  if (crank_.step().known()) hull_.carry(result_.wrench, crank_.step().length());
  turn_.published(result_);
  ++counts_.accepted;
  counts_.beside_blow += result_.beside_blow;
  counts_.uncertain += result_.uncertain && !result_.beside_blow;
  if (crank_.step().known()) counts_.misuse.work_time += crank_.step().length();
  if (boom_) followMisuse();
  return result_;
}

/// Advances everything that continues from sample to sample.
void Pipeline::follow(CrankFollower::Outcome outcome) noexcept {
  result_.stamp = crank_.stamp();  // readings may show that samples were lost
  result_.crank = crank_.estimate();
  result_.consistency = crank_.tracker().consistency();
  if (outcome == CrankFollower::Outcome::kBegan) turn_.begin(result_.stamp);
  followTrust(outcome);
  const bool counts = !trust_.refusal() && !zero_.withholds() && trust_.hasRunUp() && !crank_.suspectsUnit();
  if (!counts) turn_.discard();
  if (outcome == CrankFollower::Outcome::kContinued) {
    passBlows();
    followHull();
    rod_.follow(crank_.step(), crank_.tracker());
    rod_.setEvidence(crank_.tracker(), elastic_.isLost(), elastic_.restitution());
    elastic_.follow(crank_, hull_.motion().motion.gravity);
    unknown_.observe(crank_.tracker().constantErrors().zeroIsShown() ? elastic_.identifiedPins() : std::nullopt);
    unknown_.follow(crank_.step().length(), crank_.step().strikes(), elastic_.runs() && !elastic_.filter().hasStruck());
    if (elastic_.runs())
      crank_.inflateByRod(elastic_.filter().motion().state.angle, elastic_.filter().motion().state.speed);
    if (counts) turn_.follow(hull_.motion().motion, result_);
  } else {
    restart(outcome == CrankFollower::Outcome::kRevised);
    rod_.restart(crank_.tracker());
    elastic_.pause();
  }
}

/// Returns the reason against publishing; empty if the estimate allows it.
std::optional<Refusal> Pipeline::whyWithheld() noexcept {
  settled_ = !crank_.tracker().isUncertain() && crank_.isSettled(hull_.motion().motion, turn_.peakForce());
  if (const auto distrust = trust_.refusal()) return distrust;
  if (zero_.withholds()) return Refusal::kInconsistent;
  if (hull_.anglesLookLikeDegrees()) return Refusal::kDegrees;
  return settled_ ? std::nullopt : std::make_optional(Refusal::kUnsettled);
}

/// Fills in hull, links, wrench and pin forces.
void Pipeline::fill(const LinksForGradient& links, const DriveReaction& drive,
                    const ElasticFollower::RodLoads& rod) noexcept {
  const CrankMotion motion = motionOf(result_.crank);
  result_.level = elastic_.isWanted() && !elastic_.isUsed() ? Level::kLinkage : settings_.level;
  result_.hull = hull_.motion();
  result_.pitch_known = hull_.pitchKnown();
  result_.links = links.here.links;
  const TwoBodyState& bodies = elastic_.filter().motion().state;
  result_.rocker_displacement = elastic_.runs() ? bodies.displacement : 0.0;
  result_.rocker_displacement_rate = elastic_.runs() ? bodies.displacement_rate : 0.0;
  result_.wrench = hullWrench(model_, drive, links.here.links, motion, result_.hull.motion) + rod.wrench;
  result_.crank.acceleration += rod.crank;
  const NearBlow near = near_blow_.withAngleError(result_.deviation.angle);
  result_.pins = elastic_.runs()
                     ? elastic_.pins(result_.hull.motion, near)
                     : pinForces(mechanism_, model_.level(), links.here.links, motion, result_.hull.motion, near);
  addHullMotion(model_, drive, links.here.links, result_.crank.speed, result_.hull.motion, result_.hull.covariance,
                result_.deviation);
}

void Pipeline::followTrust(CrankFollower::Outcome outcome) noexcept {
  const double step = outcome == CrankFollower::Outcome::kContinued ? crank_.step().length() : 0.0;
  if (outcome == CrankFollower::Outcome::kBegan) trust_.begin();
  trust_.follow(crank_.reading(), crank_.tracker().strikeConsistency(), step);
  crank_.moveZero(zero_.follow(crank_.tracker(), elastic_.isUsed(), crank_.reading(), step, {hull_.gravity()}));
  crank_.setZeroContradicted(zero_.contradicts(crank_.tracker()));
  if (outcome == CrankFollower::Outcome::kContinued) {
    for (const CrankStep::Passage& passage : crank_.step())
      if (passage.forward) trust_.passBlow(settled_);
  }
  result_.inconsistent = result_.consistency > CrankTrust::kInconsistent;
}

/// Returns the ratio of present to nominal loads of a revolution, which grow with the square of the speed.
double Pipeline::speedScale() const noexcept { return square(result_.crank.speed / (kTwoPi * settings_.turn_rate)); }

bool Pipeline::isPlausible(const HullWrench& wrench) const noexcept {
  const double square_of_force = square(wrench.force_x) + square(wrench.force_z);
  if (crank_.tracker().isProven())
    return square_of_force <= square(kMostForce * nominal_force_ * std::max(1.0, speedScale()));
  const double nominal_speed = kTwoPi * settings_.turn_rate;
  return square_of_force <= square(kMostForceUnproven * nominal_force_) &&
         std::abs(result_.crank.speed) <= kMostSpeedUnproven * nominal_speed;
}

/// Returns true if the sample carries information. No force of a crank at work is as large as the peak at constant
/// speed, so that its standard deviation must not exceed that peak. A crank held at constant speed shows little of
/// itself. Its forces' standard deviations must not exceed five times withhold_above of that peak.
bool Pipeline::isKnown() const noexcept {
  // A blank firing is uncertain while the readings contradict the model.
  if (result_.crank.position.isMirrored() && result_.consistency > CrankTrust::kMost) return false;
  const double inertia = crank_.tracker().driveInertia(), given = mechanism_.parameters().drive_inertia;
  if (!crank_.tracker().constantErrors().zeroIsShown() && inertia > 0.0 &&
      std::abs(std::log(inertia / given)) > kInertiaOff)
    return false;
  // An unknown force of the rod gives no information on the crank.
  const Eigen::Vector3d squares = result_.deviation.covariance.diagonal() - result_.unknown.rowwise().sum();
  const double largest = squares.head<2>().maxCoeff();
  if (inertia > 0.0) return !(largest > square(peak_at_speed_));  // of a crank at work
  return largest <= square(kUncertain * settings_.withhold_above * std::max(1.0, speedScale()) * peak_at_speed_);
}

/// Restarts after a step that is not continued. revised: the pending blow is kept and judged later.
void Pipeline::restart(bool revised) noexcept {
  if (!revised) turn_.finishBlow(result_);
  turn_.restart();
  hull_.follow(result_.stamp, {}, {});
  sampler_.forget();
  if (revised) advanceBoom({});
  boom_follows_ = boom_follows_ && revised;
  ++counts_.restarts;
}

const SampleResult& Pipeline::end() noexcept {
  result_.turn_ends = 0;
  result_.outputs.clear();
  turn_.finishBlow(result_);
  return result_;
}

WrenchSampler Pipeline::meansAt(double rate) const {
  PipelineSettings settings = settings_;
  settings.output = OutputKind::kMean, settings.output_rate = rate;
  return {model_, columns_, crank_.step(), crank_.tracker(), elastic_, settings};
}

void Pipeline::sample(WrenchSampler& sampler, std::vector<WrenchOutput>& outputs) const noexcept {
  const CrankAngle angle = result_.crank.position.angle;
  sampler.sample(LinksForGradient(model_, elastic_.runs() ? linksAt(model_, angle) : crank_.step().links()), result_,
                 outputs);
}

SampleCounts Pipeline::counts() const noexcept {
  SampleCounts counts = counts_;
  counts.blows += turn_.blows();
  counts.impossible_blows += turn_.impossibleBlows();
  counts.backward_passes += turn_.backwardPasses();
  counts.misuse.add(misuse_.counts());
  counts.misuse.blank_firings += turn_.blankFirings();
  return counts;
}

}  // namespace hammer_loads
