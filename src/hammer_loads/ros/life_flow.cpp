#include "hammer_loads/ros/life_flow.h"

#include "hammer_loads/ros/fill_life.h"
#include "hammer_loads/tables/sha256.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

/// The same whenever this run's messages are counted, live or from a recording.
std::string runName(StampNs first_header, const std::string& machine) {
  return format("%lld-%.16s", static_cast<long long>(first_header), machine.c_str());
}

void addBeyond(std::uint64_t samples, const std::string& channel, const std::string& key, std::string& text) {
  if (samples == 0) return;
  text += (text.empty() ? "" : ", ") + channel + " (" + std::to_string(samples) + " samples, " + key + ")";
}

}  // namespace

std::vector<LifeFlow::ScaleKeys> LifeFlow::scaleKeys(const life::LifeSettings& settings) {
  std::vector<ScaleKeys> keys;
  const auto add = [&](const std::string& name, const char* unit) {
    keys.push_back({name + "_full_scale_least" + unit, name + "_full_scale_greatest" + unit});
  };
  for (const life::CountedChannel& channel : settings.channels) add(channel.key, "");
  for (const life::HotSpot& spot : settings.hot_spots) add(spot.name, "_MPa");
  return keys;
}

LifeFlow::LifeFlow(const Pipeline& pipeline, const Settings& settings, HammerOutputs& outputs, life::PieceSink* pieces)
    : follower_(pipeline, settings.life),
      outputs_(outputs),
      pieces_(pieces),
      machine_(life::ledgerMachine(settings.life, sha256Of({settings.machine}))),
      scale_keys_(scaleKeys(settings.life)),
      period_(settings.life.period) {
  prepareTurnLoads(follower_.channels(), outputs_.turn_loads.message);
}

void LifeFlow::follow(StampNs header, const ros::Time& record_time) {
  if (!begun_ && pieces_ != nullptr) pieces_->begin(machine_, runName(header, machine_.identity));
  begun_ = true;
  record_time_ = record_time;
  if (follower_.due()) {
    const life::LifePiece piece = sendCycles(record_time);
    if (pieces_ != nullptr) pieces_->add(piece);
  }
  follower_.follow();
}

void LifeFlow::sendTurn(const TurnEnd& end, const ros::Time& record_time) {
  const life::TurnLoads* turn = follower_.turnLoads(end);
  if (turn == nullptr) return;
  fillTurnLoads(end, *turn, outputs_.turn_loads.message);
  outputs_.turn_loads.send(record_time);
}

void LifeFlow::finish() {
  const life::LifePiece last = sendCycles(record_time_);
  if (pieces_ != nullptr) pieces_->end(last);
}

life::LifePiece LifeFlow::sendCycles(const ros::Time& record_time) {
  life::LifePiece piece = follower_.take();
  if (!follower_.since()) return piece;
  fillLoadCycles(*follower_.since(), *follower_.total(), machine_, outputs_.load_cycles.message);
  outputs_.load_cycles.send(record_time);
  return piece;
}

std::vector<life::SampleTally> LifeFlow::tallies() const {
  std::vector<life::SampleTally> tallies;
  for (std::size_t i = 0; i < scale_keys_.size(); ++i) {
    tallies.push_back(follower_.recorder().tally(i));
    if (follower_.total()) tallies.back().add(follower_.total()->counts[i].tally);
  }
  return tallies;
}

std::vector<Warning> LifeFlow::warnings() const {
  std::string beyond;
  const std::vector<life::SampleTally> all = tallies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& channel = follower_.recorder().channels()[i];
    addBeyond(all[i].below, channel, scale_keys_[i].least, beyond);
    addBeyond(all[i].above, channel, scale_keys_[i].greatest, beyond);
  }
  if (beyond.empty()) return {};
  return {{"full scale", "load cycles: loads beyond their full scale count at its end: " + beyond, true}};
}

}  // namespace hammer_loads
