#include "hammer_loads/ros/life_flow.h"

#include <hammer_loads/LoadCycles.h>
#include <hammer_loads/TurnLoads.h>

#include <iterator>
#include <sstream>
#include <utility>

#include "hammer_loads/life/life_recorder.h"
#include "hammer_loads/life/life_settings.h"
#include "hammer_loads/life/turn_loads.h"
#include "hammer_loads/pipeline/sample_result.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/tables/digest.h"
#include "hammer_loads/util/constants.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

void fillCount(const life::CycleCount& count, ChannelCycles& message) {
  message.least = count.grid.least();
  message.greatest = count.grid.greatest();
  message.classes = count.grid.classes();
  message.steps.clear(), message.low.clear(), message.count.clear();
  for (const life::ClosedCycles& closed : count.closed) {
    message.steps.push_back(closed.steps);
    message.low.push_back(closed.low);
    message.count.push_back(closed.count);
  }
  message.residue = count.residue;
  message.samples = count.tally.counted;
  message.skipped = count.tally.skipped;
  message.below = count.tally.below;
  message.above = count.tally.above;
  message.gaps = count.tally.gaps;
  message.minimum = count.extremes.least;
  message.maximum = count.extremes.greatest;
  message.mean_std = life::meanDeviation(count);
  const life::RangeDeviation range = life::rangeDeviation(count);
  message.range_own_std = count.tally.range_square > 0 ? range.own : kNaN;
  message.range_systematic_std = range.common;
}

void fillFigures(const life::ChannelFigures& figures, ChannelCycles& message) {
  for (std::vector<double>* values :
       {&message.equivalent_range, &message.equivalent_range_std, &message.equivalent_range_systematic_std})
    values->clear();
  for (const life::Figure& range : figures.equivalent_range) {
    message.equivalent_range.push_back(range.value);
    message.equivalent_range_std.push_back(range.deviation);
    message.equivalent_range_systematic_std.push_back(range.common);
  }
  message.largest_range = figures.largest_range;
  message.damage = figures.damage ? figures.damage->value : kNaN;
  message.damage_std = figures.damage ? figures.damage->deviation : kNaN;
  message.damage_systematic_std = figures.damage ? figures.damage->common : kNaN;
  message.remaining_hours = figures.remaining_hours ? figures.remaining_hours->value : kNaN;
}

/// Sets names, units and array sizes of the message; called once.
void prepareTurnLoads(const std::vector<std::string>& channels, TurnLoads& message) {
  message.channel = channels;
  message.unit.clear();
  for (const std::string& channel : channels) message.unit.push_back(life::unitOf(channel));
  for (std::vector<double>* values :
       {&message.minimum, &message.maximum, &message.mean, &message.minimum_std, &message.maximum_std,
        &message.minimum_systematic_std, &message.maximum_systematic_std})
    values->assign(channels.size(), kNaN);
}

/// Fills the message without allocation.
void fillTurnLoads(const TurnEnd& end, const life::TurnLoads& turn, TurnLoads& message) {
  message.header.stamp = timeOf(end.stamp);
  message.turn = end.turn;
  message.whole = turn.whole;
  message.start = timeOf(turn.start);
  for (std::size_t i = 0; i < turn.channels.size(); ++i) {
    const auto& [minimum, maximum, mean] = turn.channels[i];
    message.minimum[i] = minimum.value;
    message.maximum[i] = maximum.value;
    message.mean[i] = mean;
    message.minimum_std[i] = minimum.error.deviation();
    message.maximum_std[i] = maximum.error.deviation();
    message.minimum_systematic_std[i] = minimum.error.common;
    message.maximum_systematic_std[i] = maximum.error.common;
  }
}

/// total: counts since the count began at `since`. machine: source of the channels' S-N curves. Not for the hot path.
void fillLoadCycles(StampNs since, const life::LifePiece& total, const life::LedgerMachine& machine,
                    LoadCycles& message) {
  constexpr double kSecondsPerHour = 3600.0;
  message.header.stamp = timeOf(total.stamp);
  message.since = timeOf(since);
  message.duration = kSecondsPerNs * static_cast<double>(total.duration);
  message.turns = total.turns;
  message.equivalent_cycles_per_hour = machine.equivalent_cycles_per_hour;
  message.slope.assign(std::begin(life::kSlopes), std::end(life::kSlopes));
  message.channel.resize(machine.channels.size());
  for (std::size_t i = 0; i < machine.channels.size(); ++i) {
    const life::CountedChannel& channel = machine.channels[i];
    message.channel[i].name = channel.name;
    message.channel[i].unit = life::unitOf(channel.name);
    fillCount(total.counts[i], message.channel[i]);
    fillFigures(life::figuresOf(total.counts[i], channel, message.duration / kSecondsPerHour,
                                machine.equivalent_cycles_per_hour),
                message.channel[i]);
  }
}

constexpr std::uint64_t kNamingMessages = 64;  ///< messages whose readings distinguish runs with one first stamp
constexpr StampNs kMarkEvery = 4LL * 1000 * 1000 * 1000;  ///< [ns]: a split is longer; a working day gives 7200 marks

/// Returns a digest of the sensor's reading before any parameter is applied.
std::uint64_t readingDigest(const sensor_msgs::JointState& message, Digest digest = Digest()) {
  digest.add(stampOf(message.header.stamp));
  for (const double position : message.position) digest.add(position);
  for (const double velocity : message.velocity) digest.add(velocity);
  return digest.value();
}

/// Returns a digest of the parameters that turn readings into loads. Parameters of the machine, of the log, of counting
/// and of topics are left out.
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

LifeFlow::LifeFlow(const Pipeline& pipeline, const Settings& settings, HammerOutputs& outputs, life::PieceSink* pieces)
    : pipeline_(pipeline),
      follower_(pipeline, settings.life),
      outputs_(outputs),
      pieces_(pieces),
      machine_(life::ledgerMachine(settings.life, digestOf(settings.machine))),
      parameters_(sensorParameters(settings.yaml)),
      counts_before_(pipeline.counts()),
      period_(settings.life.period) {
  prepareTurnLoads(follower_.channels(), outputs_.turn_loads.message);
  marks_.reserve(static_cast<std::size_t>(period_ / kMarkEvery) + 64);
}

void LifeFlow::follow(const sensor_msgs::JointState& message, const ros::Time& record_time) {
  if (!first_) first_ = stampOf(message.header.stamp), digest_ = Digest().value();
  record_time_ = record_time;
  if (follower_.due()) {
    life::LifePiece piece = takePiece();
    if (named_)
      pieces_->add(piece);
    else if (pieces_ != nullptr)
      unnamed_.push_back(std::move(piece));
  }
  if (pieces_ != nullptr) mark(message);
  follower_.follow();
}

/// Marks the first message of each time slot, so that any part of a recording has the same marks. The run begins as
/// soon as it is identified, so that a problem with its ledger is reported before the first piece.
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
  life::RunId id(format("%lld-%s-%016llx", static_cast<long long>(*first_), machine_.identity.c_str(),
                        static_cast<unsigned long long>(digest_)));
  id.parameters = parameters_;
  pieces_->begin(machine_, id);
  for (const life::LifePiece& piece : unnamed_) pieces_->add(piece);
  unnamed_.clear();
}

/// Ends the piece and publishes the counts. Returns the piece with its number of messages and its marks.
life::LifePiece LifeFlow::takePiece() {
  life::LifePiece piece = follower_.take();
  piece.messages = messages_ - std::exchange(messages_kept_, messages_);
  piece.marks = marks_;
  marks_.clear();
  if (follower_.since())
    outputs_.load_cycles.send(
        record_time_, [&](LoadCycles& m) { fillLoadCycles(*follower_.since(), *follower_.total(), machine_, m); });
  return piece;
}

/// Returns the reason why most readings contradict this machine with these parameters; empty if they do not.
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
  const life::LifePiece last = takePiece();
  if (pieces_ == nullptr) return;
  name();
  const std::string reason = contradiction();
  if (!reason.empty()) pieces_->refuse(reason);
  pieces_->end(last);
}

std::vector<life::SampleTally> LifeFlow::tallies() const {
  std::vector<life::SampleTally> tallies;
  for (std::size_t i = 0; i < machine_.channels.size(); ++i) {
    tallies.push_back(follower_.recorder().tally(i));
    if (follower_.total()) tallies.back().add(follower_.total()->counts[i].tally);
  }
  return tallies;
}

std::vector<Warning> LifeFlow::warnings() const {
  std::string beyond;
  const std::vector<life::SampleTally> all = tallies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const life::CountedChannel& channel = machine_.channels[i];
    const std::string scale = channel.key + "_full_scale_", unit = channel.influences.empty() ? "" : "_MPa";
    addBeyond(all[i].below, channel.name, scale + "least" + unit, beyond);
    addBeyond(all[i].above, channel.name, scale + "greatest" + unit, beyond);
  }
  if (beyond.empty()) return {};
  return {{"full scale", "load cycles: loads beyond their full scale count at its end: " + beyond, true}};
}

}  // namespace hammer_loads
