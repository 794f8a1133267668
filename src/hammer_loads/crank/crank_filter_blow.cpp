// Filter at the blow: early contact with the tool, side of a sample, revolutions without contact.
#include <algorithm>
#include <cmath>

#include "hammer_loads/crank/crank_filter.h"
#include "hammer_loads/util/ablation.h"
#include "hammer_loads/util/square.h"

namespace hammer_loads {
namespace {

using Belief = CrankBelief;

constexpr double kNearCounts = 4.0;       // counts from the blow within which the encoder decides its side
constexpr double kCertain = gate::kRare;  // of the stamp: within it the encoder's edge decides nothing
constexpr double kToolDeviation = 0.5;    // of the crank's speed: what a tool met there may take
constexpr double kHiddenBranch = 0.25;    // probability: the other branch is then two standard deviations away
constexpr double kRingOver = 0.8;         // [rad] behind the blow: a rod's vibration is not taken for a torque any more
constexpr double kToolSeenByStamps = gate::kImpossible;  // shows it where stamps jitter
// Prior: kToolDeviation, kHiddenBranch

}  // namespace

bool CrankFilter::isAtTool(double dt) const noexcept {
  return isNearTool(now_.state, dt) && now_.state.speed > kCreeping && !mirrored_;
}

/// (4) Detects early contact with the tool by a crank that is suddenly slower near the dead centre. Returns true if the
/// belief has included it.
bool CrankFilter::meetsTool(double dt, const Innovation& angle, const WeighedSample& sample) noexcept {
  const bool before = now_.state.position.angle.side == Side::kBeforeBlow;
  if (HAMMER_LOADS_ABLATE(tool_met) || !before || !(angle.value < 0.0) || !isAtTool(dt)) return false;
  const bool jitters = sample.timing_variance > 0.0;
  bool seen = angle.exceeds(jitters ? kToolSeenByStamps : kToolSeen);
  if (sample.speed) {
    const Innovation speed = sample.ofSpeed(now_, model_);
    const bool slower = speed.value < 0.0;  // a stamp does not move it
    seen = (slower && speed.exceeds(kToolSeen)) || (seen && (!jitters || (slower && speed.exceeds(gate::kUsual))));
  }
  if (!seen) return false;
  now_.meetTool(kToolDeviation, dt);
  now_.tool_met = now_.struck_early = true;
  return true;
}

/// (4) Detects an unusual blow by a crank that is slower or faster than expected just after it.
bool CrankFilter::meetsOtherBlow(double dt, const Innovation& angle, const WeighedSample& sample) noexcept {
  const bool after = now_.state.position.angle.side == Side::kAfterBlow && sample.angle > 0.0;
  if (HAMMER_LOADS_ABLATE(other_blow) || !after || !isAtTool(dt)) return false;
  const double least = sample.timing_variance > 0.0 ? kToolSeenByStamps : kToolSeen;
  bool by_angle = angle.exceeds(least) && !isContradiction(dt, angle);
  if (sample.speed) {
    const Innovation speed = sample.ofSpeed(now_, model_);
    const double ratio = speed.value * angle.value > 0.0 ? speed.ratio() : 0.0;
    if (ratio > square(kToolSeen)) return now_.doubtBlow(Belief::kSpeed, speed.value, speed.total, dt);
    by_angle = by_angle && ratio > 1.0;  // the prior may explain the speed; where both go one way it is the blow
  }
  return by_angle && now_.doubtBlow(Belief::kAngle, angle.value, angle.total, dt);
}

/// (7) Undoes a predicted blow that has not occurred within this step.
void CrankFilter::undoBlow(const CrankBelief& last, double dt, const WeighedSample& sample) noexcept {
  hypothesis_.drop();
  now_ = last;
  predict(dt, false, now_);
  Innovation again = sample.ofAngle(now_);
  const bool may_be_tool = again.value > -std::abs(last.state.speed) * dt;  // which stops the crank at most
  if (may_be_tool && meetsTool(dt, again, sample)) again = sample.ofAngle(now_);
  now_.correct(Belief::kAngle, again.value, again.variance, again.by_error);
  if (now_.state.position.isMirrored()) now_.standAtBlow();
}

/// (7) The corrected angle may lie on the other side of the blow than the prediction. Forward: it passes the blow late.
/// Back over a blow that was predicted within this very step: there was none yet.
void CrankFilter::settleSide(const CrankBelief& last, double dt, const WeighedSample& sample, bool struck) noexcept {
  CrankAngle& angle = now_.state.position.angle;
  if (mirrored_) {
    mirrored_ = now_.state.position.isMirrored();
    return;
  }
  if (!now_.state.position.isMirrored()) return;
  if (angle.side == Side::kBeforeBlow) {
    if (now_.state.speed > 0.0) {
      beginHypothesis(now_);
      return now_.passLate(step_model_, blows_.prior());
    }
    angle.side = Side::kAfterBlow;
    return;
  }
  if (struck) return undoBlow(last, dt, sample);
  const double doubt =
      kNearCounts * encoder_.resolution() + kCertain * std::sqrt(sample.angleVariance(now_.state.speed));
  if (angle.offset > -doubt && now_.state.speed > -1.0) {
    now_.standAtBlow();  // it stands or goes on, whatever a count or a stamp says
  } else {
    angle.side = Side::kBeforeBlow;
  }
}

/// Side of the blow by the count, which is certain if an edge of the count is at the blow and the stamp is exact.
std::optional<Side> CrankFilter::readSide(double reading) const noexcept {
  if (HAMMER_LOADS_ABLATE(encoder_edge) || encoder_.isFiner() || settings_.angle_noise > 0.0 || angle_lag_.isThere())
    return std::nullopt;
  constexpr double kEdge = 1e-6;  // of a count
  // Numerical: kEdge
  const double count = encoder_.resolution(), edge_tolerance = kEdge * count;
  const double doubt = kCertain * std::abs(now_.state.speed) * timing_.deviation();
  const auto [low, high] = encoder_.edges(reading);
  if (low - doubt > -edge_tolerance) return Side::kAfterBlow;
  if (high + doubt < edge_tolerance) return Side::kBeforeBlow;
  return std::nullopt;
}

/// (7) The estimate may not pass the blow before the encoder does. Matters because the wrench jumps at the blow.
void CrankFilter::respectCount(const CrankBelief& last, double dt, bool struck, const WeighedSample& sample,
                               double reading) noexcept {
  CrankAngle& angle = now_.state.position.angle;
  const double near = kNearCounts * encoder_.resolution();
  if (!read_side_ || mirrored_ || std::abs(angle.offset) > near) return;
  if (std::abs(encoder_.edges(reading).low) > near) return;
  if (*read_side_ == Side::kAfterBlow && angle.side == Side::kBeforeBlow) {
    beginHypothesis(now_);
    angle.offset = 0.0;
    now_.passLate(step_model_, blows_.prior());
  }
  if (*read_side_ == Side::kAfterBlow || angle.side == Side::kBeforeBlow) return;
  if (struck) return undoBlow(last, dt, sample);
  angle = {0.0, Side::kBeforeBlow};
  now_.tool_met = true;  // its factor is in the speed already
}

/// Begins the second hypothesis, without contact, before the belief passes the blow with contact. A crank that rests
/// there does not pass it.
void CrankFilter::beginHypothesis(const CrankBelief& belief) noexcept {
  if (!HAMMER_LOADS_ABLATE(contact_hypothesis) && !mirrored_ && !belief.tool_met && belief.state.speed > kLearnSpeed)
    hypothesis_.begin(belief);
}

/// (9) The vibration of a rod may pass for the torque that shows a missed tool: the question then stays open to the
/// next dead centre.
double CrankFilter::otherBranch() const noexcept {
  return std::max(hypothesis_.probability(), mirrored_ && rod_hides_branch_ ? kHiddenBranch : 0.0);
}

/// (9) Switches to the second hypothesis if it explains a sample that the estimate does not.
bool CrankFilter::hypothesisExplains(double dt, const WeighedSample& sample) noexcept {
  if (!hypothesis_.isOpen()) return false;
  CrankBelief other = hypothesis_.belief();
  predict(dt, mirrored_, other);
  return !sample.ofAngle(other).exceeds(gate::kRare);
}

/// (9) Examines the other branch half a turn after a blow. On a wrong branch no sample need contradict the estimate,
/// because the estimated torque compensates the blow. If the supply never has such a torque, the other branch is tried
/// with a usual one.
void CrankFilter::doubtContact() noexcept {
  if (HAMMER_LOADS_ABLATE(contact_by_torque) || !(now_.state.position.angle.offset > kRingOver)) return;
  supply_.feel(now_.state.torque);
  if (hypothesis_.isThere()) return;
  const double doubt = consistency_.doubt();
  const double variance = supply_.usual() + doubt * now_.covariance(Belief::kTorque, Belief::kTorque);
  if (doubt > mismatch::kContradicts || !exceeds(now_.state.torque, variance, gate::kImpossible)) return;
  CrankBelief other = now_;
  other.state.torque = 0.0;
  other.draw(Belief::kTorque, supply_.usual());
  rod_hides_branch_ = rod_.followed;
  hypothesis_.ask(other);
}

}  // namespace hammer_loads
