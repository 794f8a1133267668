#include "hammer_loads/ros/bag_processing.h"

#include <algorithm>
#include <system_error>

#include "hammer_loads/log/bag_writer.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/bag_tables.h"
#include "hammer_loads/ros/hammer_inputs.h"
#include "hammer_loads/ros/output.h"
#include "hammer_loads/ros/stamp.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

/// Topics to read, and their types.
using Wanted = std::map<std::string, std::string>;

/// Processing of a recording by the hammer's bridge, run by run.
class HammerRuns {
 public:
  HammerRuns(const std::vector<BagRun>& runs, const BagJob& job, BagReport& report)
      : runs_(runs), job_(job), report_(report) {
    if (!job.output.empty()) bag_.emplace(job.output);
    if (!job.tables.empty()) tables_.emplace(job.tables, job.inputs);
    begin();
  }

  void take(const BagMessage& item) {
    while (next_ < runs_.size() && item.time >= runs_[next_].from) {
      end();
      begin();
    }
    const std::vector<MeasuredLoad>& loads = job_.reference;
    for (; next_load_ < loads.size() && loads[next_load_].stamp <= stampOf(item.time); ++next_load_)
      flow_->measured(loads[next_load_].stamp, loads[next_load_].load);
    inputs_->forEach([&](auto& input) {
      if (item.connection->topic != input.topic || !(input.wanted || input.latched)) return;
      item.to(input.message);
      ++input.count;
      input.take(*flow_, input.message, item.time);
      if (input.latched)
        latched_.push_back([take = input.take, message = input.message, time = item.time](HammerBridge& flow) {
          take(flow, message, time);
        });
    });
  }

  void end() {
    flow_->end();
    ++report_.runs;
    report_.samples += inputs_->crank.count;
    add(flow_->pipeline().counts(), report_.crank);
    report_.wrenches += flow_->outputs().hull_wrench.sent();
    report_.turns += flow_->outputs().blow.sent();
    warnOfRun(*flow_, inputs_->joint_states.count > 0, static_cast<std::int64_t>(report_.runs), report_.warnings);
    flow_->finishCount();
    if (tables_) tables_->end(*flow_, inputs_->crank.count);
  }

  /// Completes the tables and the bag after the last run.
  void finish() {
    if (tables_) tables_->finish(report_.warnings);
    if (bag_) bag_->close();
  }
  std::string tablesProblem() const { return tables_ ? tables_->problem() : ""; }

 private:
  void begin() {
    const Settings& settings = runs_[next_++].settings;
    flow_.emplace(settings, job_.pieces);
    inputs_.emplace(settings);
    if (bag_) attachToBag(flow_->outputs(), *bag_, job_.output_prefix, job_.pins);
    if (tables_) tables_->begin(*flow_);
    for (const auto& take : latched_) take(*flow_);
  }

  const std::vector<BagRun>& runs_;
  const BagJob& job_;
  BagReport& report_;
  std::optional<BagWriter> bag_;
  std::optional<BagTables> tables_;
  std::size_t next_{}, next_load_{};
  std::optional<HammerBridge> flow_;
  std::optional<HammerInputs> inputs_;                       ///< inputs of this run
  std::vector<std::function<void(HammerBridge&)>> latched_;  ///< latched messages, which are repeated in every run
};

Wanted wantedTopics(const std::vector<BagRun>& runs) {
  Wanted wanted;
  for (const BagRun& run : runs) {
    HammerInputs(run.settings).forEach([&wanted](const auto& input) {
      using Message = typename std::decay_t<decltype(input)>::Message;
      if (input.wanted) wanted.emplace(input.topic, typeOf<Message>());
    });
  }
  return wanted;
}

/// Returns a wanted topic whose messages have another type than required, in one line; empty if there is none.
std::string typeProblem(const BagInputs& inputs, const Wanted& wanted) {
  for (const auto& [name, type] : wanted) {
    const auto found = inputs.topics().find(name);
    if (found == inputs.topics().end()) continue;
    for (const std::string& actual : found->second.types) {
      if (actual != type) return name + " is of type " + onOneLine(actual) + ", must be " + type;
    }
  }
  return {};
}

/// Writes the requested bag and tables. Returns a problem in one line; empty if there is none.
std::string write(const BagInputs& inputs, const BagJob& job, const std::vector<BagRun>& runs,
                  const std::function<void(double)>& progress, BagReport& report) {
  std::set<std::string> topics, heard;
  for (const auto& [name, type] : wantedTopics(runs)) topics.insert(name);
  try {
    HammerRuns hammer(runs, job, report);
    BagMessages messages = inputs.messagesOn(topics);
    std::set<const BagConnection*> connections;  // known ones, so that each topic is looked up once only
    const auto count = static_cast<double>(messages.size());
    double done = 0.0;
    while (hammer.tablesProblem().empty()) {
      const BagMessage* item = messages.next();
      if (item == nullptr) break;
      progress(++done / count);
      if (connections.insert(item->connection).second) heard.insert(item->connection->topic);
      hammer.take(*item);
    }
    if (hammer.tablesProblem().empty()) {
      hammer.end();
      warnOfRecording(inputs, runs, topics, heard, report.warnings);
    }
    hammer.finish();
    if (!hammer.tablesProblem().empty()) return job.tables + ": cannot be written: " + hammer.tablesProblem();
    return {};
  } catch (const std::system_error& error) {  // errors of inputs have another class
    if (job.output.empty()) throw;
    return job.output + ": cannot be written: " + error.code().message();
  }
}

}  // namespace

std::vector<std::string> processBag(const BagJob& job, const std::function<void(double)>& progress, BagReport& report) {
  const Checked<BagInputs> inputs = BagInputs::open(job.inputs);
  if (!inputs.value) return inputs.problems;
  const std::string& names = inputs.value->names();
  try {
    const Checked<std::vector<BagRun>> runs = runsOf(*inputs.value, job, report.warnings);
    if (!runs.value) return runs.problems;
    report.notes = runs.notes;
    if (!job.output.empty()) report.prefix = job.output_prefix;
    const bool crank = std::any_of(runs.value->begin(), runs.value->end(), [&](const BagRun& run) {
      return inputs.value->has(run.settings.input_topics.crank);
    });
    if (!crank)
      return {names + ": no topic " + runs.value->front().settings.input_topics.crank +
              ", is required; topics there: " + inputs.value->topicList()};
    const std::string problem = typeProblem(*inputs.value, wantedTopics(*runs.value));
    if (!problem.empty()) return {names + ": " + problem};
    const std::string failure = write(*inputs.value, job, *runs.value, progress, report);
    if (!failure.empty()) return {failure};
    if (isUseless(report)) return {names + ": " + noWrench(*inputs.value, runs.value->back(), report)};
    if (!job.tables.empty() && report.crank.contradictSince({}))
      return {names + ": no tables, for some of their figures would be wrong: " + contradictionsOf(report.warnings)};
    return {};
  } catch (const std::exception& error) {
    return {names + ": cannot be read: " + onOneLine(error.what())};
  }
}

}  // namespace hammer_loads
