// The sensors' time: forces and blows act on the modes at the IMU's stamps; the returned motion is that at the crank's
// stamps.
#include <algorithm>
#include <cmath>

#include "hammer_loads/boom/mode_identifier.h"
#include "hammer_loads/util/functions.h"

namespace hammer_loads {
namespace {

constexpr double kLeastStep = 0.25;  // part of the crank's step, just after the delay was identified
// Numerical: kLeastStep

}  // namespace

/// Takes forces from the queue until the IMU's delay remains in it; the delay changes little in a step. With early
/// stamps the sensors' time waits for the crank.
void ModeIdentifier::takeForces(double step) noexcept {
  const double early = std::max(0.0, -imuDelay());
  const double own = std::max(kLeastStep * step, step + waiting_ - early);
  waiting_ += step - own;
  double due = held_.length() - std::max(0.0, imuDelay());
  if (!(due > 0.0)) return advanceModes({own, force_, force_, force_, false, {}});
  const double stretch = own / due;
  while (!held_.empty()) {
    HeldForces::Piece piece = held_.take(due);
    if (!(piece.duration > 0.0)) break;
    due -= piece.duration;
    piece.duration *= stretch;
    if (struck_) addBlowToDelay(piece.from - force_);
    advanceModes(piece);
    if (piece.strikes) takeBlow(piece.jump);
  }
}

void ModeIdentifier::strike(const JointVector& impulse) noexcept {
  if (!moving_known_) return;
  ModeVector jump = ModeVector::Zero();
  jump.head(count_) = modalForce(modes_, impulse);
  if (!held_.empty()) return held_.strike(jump);
  takeBlow(jump);
}

void ModeIdentifier::takeBlow(const ModeVector& jump) noexcept {
  for (int k = 0; k < count_; ++k) {
    state_[at(k, kV)] += jump[k];
    history_.strike(k, jump[k]);
    covariance_(at(k, kV), at(k, kV)) += square(kForcePart * jump[k]);
  }
  struck_ = jump;
}

/// Correction for a blow that acts a little later. force: change of the forces by the blow.
void ModeIdentifier::addBlowToDelay(const ModeVector& force) noexcept {
  for (int k = 0; k < count_ && isDelayFollowed(Clock::kImu); ++k) {
    const Mode m = modeAt(k);
    const double jump = (*struck_)[k];
    const int x = at(k, kX) - begin();
    TwoOf of;
    of.add(x + kX, 1.0, 0.0);
    of.add(x + kV, 0.0, 1.0);
    of.add(delayAt(Clock::kImu) - begin(), -jump, 2.0 * m.zeta * m.omega * jump - force[k]);
    replaceTwo(block(), x, of);
  }
  struck_.reset();
}

/// State at the crank's stamp.
ModeState ModeIdentifier::motion(int mode) const noexcept {
  return momentAt(mode, imuDelay() + waiting_ - crankLead()).state;
}

/// State in the sensors' time.
ModeHistory::Moment ModeIdentifier::momentAt(int mode, double ahead) const noexcept {
  ModeHistory::Place place;
  if (ahead < 0.0 && history_.find(-ahead, place)) return history_.at(place, mode, modeAt(mode).omega, stateOf(mode));
  return momentAhead(mode, ahead);
}

/// State carried through the queued forces by a Taylor series of third order, with an error of 1e-4 for 0.5 ms of the
/// fastest mode. Beyond the queue, and before the history, the last force is kept.
ModeHistory::Moment ModeIdentifier::momentAhead(int mode, double ahead) const noexcept {
  const Mode m = modeAt(mode);
  const double beside = forceOfSeals(way_)[mode] + rockOn(mode) * state_[kContact], damped = 2.0 * m.zeta * m.omega;
  ModeHistory::Moment moment{stateOf(mode), force_[mode], force_rate_[mode]};
  const auto move = [&](double h) {
    ModeState& now = moment.state;
    const double a = acceleration(m, now, moment.force + beside);
    const double jerk = moment.force_rate - damped * a - square(m.omega) * now.v;
    now.x += h * (now.v + 0.5 * h * (a + h / 3.0 * jerk)), now.v += h * (a + 0.5 * h * jerk);
    moment.force += h * moment.force_rate;
  };
  double left = ahead;
  held_.forEach([&](const HeldForces::Piece& piece) {
    if (!(left > 0.0)) return;
    moment.force = piece.from[mode], moment.force_rate = (piece.to[mode] - piece.from[mode]) / piece.duration;
    move(std::min(left, piece.duration));
    if (left >= piece.duration) moment.state.v += piece.jump[mode];
    left = std::max(0.0, left - piece.duration);
  });
  move(left);
  return moment;
}

}  // namespace hammer_loads
