#include "hammer_loads/simulation/elastic_machine.h"

namespace hammer_loads::simulation {

void ElasticMachine::followBlow() {
  BlowTruth* begun =
      follower_.follow({time_, now_[kCrankSpeed], now_[kRockerSpeed], striker(now_).speed, now_[kToolImpulse],
                        now_[kToolEnergy], now_[kRetainerImpulse], StruckTool::touches(contacts_)});
  if (!begun) return;
  begun->turn_period = time_ - current_.start;
  begun->turn_peak_force_z = current_.peak;
  begun->turn_impulse_x = now_[kImpulseX] - current_.impulse_x;
  begun->turn_impulse_z = now_[kImpulseZ] - current_.impulse_z;
  begun->last_lobe_impulse_z = now_[kImpulseZ] - current_.lobe;
  begun->whole_turn = current_.whole;
  current_ = {time_, now_[kImpulseX], now_[kImpulseZ], now_[kImpulseZ], slope_[kImpulseZ], true};
}

/// Resets the tool, as the hull follows or the tool slides back; its remaining energy is counted as the rock's.
void ElasticMachine::putToolBack() {
  const auto energy = [this] { return struck_.energy(striker(now_), tool(now_)); };
  const double before = energy();
  struck_.newTurn(time_);
  now_[kToolWay] = now_[kToolSpeed] = now_[kYielded] = 0.0;
  put_back_ += before - energy();
  contacts_ = contacts(now_);
  rate(now_, slope_, time_);
}

}  // namespace hammer_loads::simulation
