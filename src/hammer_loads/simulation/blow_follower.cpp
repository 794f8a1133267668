#include "hammer_loads/simulation/blow_follower.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kSlowest = 1.0;   // [m/s]; at work it is some 9
constexpr double kLongest = 0.02;  // [s]

}  // namespace

BlowTruth* BlowFollower::follow(const Instant& now) {
  const bool before = touched_;
  touched_ = now.touches;
  if (meeting_ && now.time > meeting_->truth.time + kLongest) end(now);
  BlowTruth* begun = nullptr;
  if (now.touches && !before && !meeting_ && now.approach > kSlowest) {
    meeting_.emplace();
    meeting_->begun = now;
    begun = &meeting_->truth;
    begun->time = now.time;
    begun->crank_speed = now.crank_speed;
    begun->strike.rocker_speed_before = now.rocker_speed;
  }
  if (!meeting_) return nullptr;
  BlowTruth& truth = meeting_->truth;
  if (now.touches && !before) meeting_->touched = now.time, ++truth.touches;
  if (before && !now.touches) {
    truth.contact += now.time - meeting_->touched;
    truth.strike.rocker_speed_after = now.rocker_speed;
    truth.strike.crank_speed_after = now.crank_speed;
  }
  return begun;
}

void BlowFollower::end(const Instant& now) {
  BlowTruth& truth = meeting_->truth;
  truth.strike.tool_impulse = now.tool_impulse - meeting_->begun.tool_impulse;
  truth.strike.energy = now.tool_energy - meeting_->begun.tool_energy;
  truth.retainer_impulse = now.retainer_impulse - meeting_->begun.retainer_impulse;
  blows_.push_back(truth);
  meeting_.reset();
}

}  // namespace hammer_loads::simulation
