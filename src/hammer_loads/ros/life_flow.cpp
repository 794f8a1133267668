#include "hammer_loads/ros/life_flow.h"

#include <sstream>
#include <utility>

#include "hammer_loads/ros/fill_life.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/util/digest.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

constexpr std::uint64_t kNamingMessages = 64;             ///< whose readings distinguish runs with one first stamp
constexpr StampNs kMarkEvery = 4LL * 1000 * 1000 * 1000;  ///< [ns]: a split is longer; a working day gives 7200 marks

/// The sensor's reading before any parameter is applied.
std::uint64_t readingDigest(const sensor_msgs::JointState& message, Digest digest = Digest()) {
  digest.add(stampOf(message.header.stamp));
  for (const double position : message.position) digest.add(position);
  for (const double velocity : message.velocity) digest.add(velocity);
  return digest.value();
}

/// Digest of the parameters that turn readings into loads, without those of the machine, of the log, of counting and of
/// topics.
std::string sensorParameters(const std::string& yaml) {
  std::istringstream lines(yaml);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("crank_", 0) == 0 || line.rfind("hull_", 0) == 0 || line.rfind("pitch_", 0) == 0 ||
        line.rfind("base_", 0) == 0 || line.rfind("joint_", 0) == 0)
      kept += line + '\n';
  }
  return digestOf(kept);
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
    : pipeline_(pipeline),
      follower_(pipeline, settings.life),
      outputs_(outputs),
      pieces_(pieces),
      machine_(life::ledgerMachine(settings.life, digestOf(settings.machine))),
      parameters_(sensorParameters(settings.yaml)),
      counts_before_(pipeline.counts()),
      scale_keys_(scaleKeys(settings.life)),
      period_(settings.life.period) {
  prepareTurnLoads(follower_.channels(), outputs_.turn_loads.message);
  marks_.reserve(static_cast<std::size_t>(period_ / kMarkEvery) + 64);
}

void LifeFlow::follow(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  if (!begun_) first_ = stampOf(message.header.stamp), digest_ = Digest().value();
  begun_ = true;
  record_time_ = record_time;
  if (follower_.due()) {
    life::LifePiece piece = sendCycles(record_time);
    if (pieces_ != nullptr) keep(std::move(piece));
  }
  if (pieces_ != nullptr) mark(message);
  follower_.follow();
}

/// Marks the first message of each stretch of time, so that any part of a recording has the same marks. The run begins
/// as soon as it is identified, so that a problem with its ledger is reported before the first piece.
void LifeFlow::mark(const sensor_msgs::JointState& message) {
  if (messages_ < kNamingMessages) digest_ = readingDigest(message, Digest(digest_));
  if (++messages_ == kNamingMessages) name();
  const StampNs slot = stampOf(message.header.stamp) / kMarkEvery;
  if (slot_ && slot > *slot_) marks_.push_back(static_cast<std::int64_t>(readingDigest(message)));
  slot_ = slot;
}

void LifeFlow::name() {
  if (named_) return;
  named_ = true;
  life::RunId id(format("%lld-%s-%016llx", static_cast<long long>(first_), machine_.identity.c_str(),
                        static_cast<unsigned long long>(digest_)));
  id.parameters = parameters_;
  pieces_->begin(machine_, id);
  for (const life::LifePiece& piece : unnamed_) pieces_->add(piece);
  unnamed_.clear();
}

/// With the messages and marks that it belongs to.
void LifeFlow::keep(life::LifePiece piece) {
  piece.messages = messages_ - std::exchange(messages_kept_, messages_);
  piece.marks.assign(marks_.begin(), marks_.end());
  marks_.clear();
  if (!named_) return unnamed_.push_back(std::move(piece));
  pieces_->add(piece);
}

/// Reason why most of the readings cannot be those of this machine with these parameters; empty: they can.
std::string LifeFlow::contradiction() const {
  if (!pipeline_.counts().contradictSince(counts_before_)) return {};
  for (const Warning& warning : warningsOf(pipeline_))
    if (isContradiction(warning.key)) return warning.text;
  return "crank: most readings contradict the model";
}

void LifeFlow::sendTurn(const TurnEnd& end, const ros::Time& record_time) {
  const life::TurnLoads* turn = follower_.turnLoads(end);
  if (turn == nullptr) return;
  outputs_.turn_loads.send(record_time, [&](TurnLoads& m) { fillTurnLoads(end, *turn, m); });
}

void LifeFlow::finish() {
  life::LifePiece last = sendCycles(record_time_);
  if (pieces_ == nullptr) return;
  name();
  last.messages = messages_ - std::exchange(messages_kept_, messages_);
  last.marks = std::move(marks_);
  const std::string reason = contradiction();
  if (!reason.empty()) pieces_->refuse(reason);
  pieces_->end(last);
}

life::LifePiece LifeFlow::sendCycles(const ros::Time& record_time) {
  life::LifePiece piece = follower_.take();
  if (!follower_.since()) return piece;
  outputs_.load_cycles.send(
      record_time, [&](LoadCycles& m) { fillLoadCycles(*follower_.since(), *follower_.total(), machine_, m); });
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
