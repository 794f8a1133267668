#include <utility>

#include "hammer_loads/simulation/elastic_machine.h"

namespace hammer_loads::simulation {
namespace {

constexpr double kSlowest = 0.1;   // approach that counts as a blow [m/s]; the crank that leans on the tool is none
constexpr double kLongest = 0.02;  // from the first touch to the last parting [s]

}  // namespace

/// After a step that began with other contacts or the same.
void ElasticMachine::followBlow(int before) {
  const bool touched = StruckTool::touches(before), touches = StruckTool::touches(contacts_);
  if (meeting_ && time_ > meeting_->truth.time + kLongest) endBlow();
  if (touches && !touched && !meeting_ && striker(now_).speed > kSlowest) beginBlow();
  if (!meeting_) return;
  Meeting& m = *meeting_;
  if (touches && !touched) m.touched = time_, ++m.truth.touches;
  if (!touched || touches) return;
  m.parted = time_;
  m.truth.contact += m.parted - m.touched;
  m.truth.strike.rocker_speed_after = now_[kRockerSpeed];
  m.truth.strike.crank_speed_after = now_[kCrankSpeed];
}

void ElasticMachine::beginBlow() {
  Meeting m;
  m.impulse = now_[kToolImpulse], m.energy = now_[kToolEnergy], m.retainer = now_[kRetainerImpulse];
  BlowTruth& t = m.truth;
  t.time = time_;
  t.crank_speed = now_[kCrankSpeed];
  t.strike.rocker_speed_before = now_[kRockerSpeed];
  t.turn_period = time_ - current_.start;
  t.turn_peak_force_z = current_.peak;
  t.turn_impulse_x = now_[kImpulseX] - current_.impulse_x;
  t.turn_impulse_z = now_[kImpulseZ] - current_.impulse_z;
  t.last_lobe_impulse_z = now_[kImpulseZ] - current_.lobe;
  t.whole_turn = current_.whole && turn_ > 0;
  meeting_ = m;
  current_ = {time_, now_[kImpulseX], now_[kImpulseZ], now_[kImpulseZ], slope_[kImpulseZ], true};
}

void ElasticMachine::endBlow() {
  Meeting& m = *meeting_;
  m.truth.strike.tool_impulse = now_[kToolImpulse] - m.impulse;
  m.truth.strike.energy = now_[kToolEnergy] - m.energy;
  m.truth.retainer_impulse = now_[kRetainerImpulse] - m.retainer;
  blows_.push_back(m.truth);
  meeting_.reset();
}

/// The hull follows, or the tool slides back: what it still had of energy is the rock's.
void ElasticMachine::putToolBack() {
  const auto energy = [this] { return struck_.energy(striker(now_), tool(now_)); };
  const double before = energy();
  struck_.newTurn(time_);
  now_[kToolWay] = now_[kToolSpeed] = now_[kYielded] = 0.0;
  put_back_ += before - energy();
  contacts_ = contacts(now_);
  rate(now_, slope_, time_);
}

std::vector<BlowTruth> ElasticMachine::takeBlows() { return std::exchange(blows_, {}); }

}  // namespace hammer_loads::simulation
