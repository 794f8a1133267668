#include <hammer_loads/RunInfo.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "hammer_loads/ros/bag_processing.h"
#include "hammer_loads/ros/hammer_inputs.h"
#include "hammer_loads/settings/readers.h"
#include "hammer_loads/settings/yaml_value.h"
#include "hammer_loads/tables/digest.h"
#include "hammer_loads/util/format.h"

namespace hammer_loads {
namespace {

struct RecordedRun {
  ros::Time time;  ///< time of its record
  RunInfo info;
};

struct RunInfos {
  std::set<std::string> topics;  ///< topics of hammers; more than one: several nodes
  std::vector<RecordedRun> runs;
};

bool isOfHammer(const RunInfo& info) {
  std::vector<std::string> ignored;
  const std::optional<ParameterMap> parameters = recordedParameters(info.parameters_yaml, ignored);
  return parameters && hasHammerKey(*parameters);
}

/// Returns true for a repetition. Each bag of a recording repeats the run_info in force.
bool isRepeated(const std::vector<RecordedRun>& runs, const RunInfo& info) {
  return !runs.empty() && runs.back().info.header.stamp == info.header.stamp &&
         runs.back().info.parameters_yaml == info.parameters_yaml &&
         runs.back().info.robot_description == info.robot_description;
}

RunInfos readRunInfos(const BagInputs& inputs, std::vector<BagWarning>& warnings) {
  RunInfos found;
  BagMessages messages =
      inputs.messages([](const BagConnection& connection) { return connection.type == typeOf<RunInfo>(); });
  RunInfo info;
  while (const BagMessage* item = messages.next()) {
    const std::string& topic = item->connection->topic;
    if (!item->is<RunInfo>()) {
      addOnce(warnings,
              {"definitions", topic + ": hammer_loads/RunInfo of another definition (MD5 " + item->connection->md5sum +
                                  ", here " + ros::message_traits::md5sum<RunInfo>() + "), is not used"});
      continue;
    }
    item->to(info);
    if (!isOfHammer(info)) continue;
    found.topics.insert(topic);
    if (!isRepeated(found.runs, info)) found.runs.push_back({item->time, info});
  }
  return found;
}

/// Returns the settings with the topics of the job, of the parameters or of the recording, in this order of priority.
Settings withTopics(Settings settings, const InputTopics& given, const InputTopics& recorded = {}) {
  const InputTopics topics = inputTopics([&](const InputName& input) -> std::string {
    for (const InputTopics& known : {given, settings.input_topics, recorded})
      if (!(known.*input.topic).empty()) return known.*input.topic;
    return input.recorded;
  });
  return withInputTopics(std::move(settings), topics);
}

InputTopics recordedTopics(const RunInfo& info) {
  std::vector<std::string> ignored;
  ParameterReader reader(recordedParameters(info.parameters_yaml, ignored).value_or(ParameterMap{}));
  return readInputTopics(reader);
}

Checked<std::vector<BagRun>> runOfJob(const BagJob& job, const RunInfos& infos, std::vector<BagWarning>& warnings) {
  Checked<std::vector<BagRun>> result;
  const ParameterMap parameters = job.parameters.value_or(ParameterMap{});
  std::string description = job.robot_description.value_or("");
  InputTopics topics;
  if (infos.topics.size() == 1) {
    topics = recordedTopics(infos.runs.front().info);
    if (!job.robot_description) description = infos.runs.front().info.robot_description;
    if (!job.robot_description && !description.empty())
      result.notes.push_back("robot_description of " + *infos.topics.begin() + " is used; --urdf replaces it");
  }
  Checked<Settings> settings = load(configDirectory(), parameters, description);
  result.problems = std::move(settings.problems);
  if (!settings.value) return result;
  if (!hasHammerKey(parameters))
    addOnce(warnings, {"hammer", "no hammer file was given (--params): the masses and lengths of the MO-100 are used"});
  result.notes.insert(result.notes.end(), settings.value->notes.begin(), settings.value->notes.end());
  result.value.emplace().push_back({ros::Time(), withTopics(*std::move(settings.value), job.topics, topics)});
  return result;
}

/// Returns the first record time of an input of the run; nothing if there is none.
std::optional<ros::Time> firstInput(const BagInputs& inputs, const Settings& settings) {
  std::set<std::string> names;
  HammerInputs(settings).forEachSensor([&names](const auto& input) { names.insert(input.topic); });
  BagMessages messages = inputs.messagesOn(names);
  const BagMessage* first = messages.next();
  return first == nullptr ? std::nullopt : std::make_optional(first->time);
}

Checked<std::vector<BagRun>> recordedRuns(const BagInputs& inputs, const BagJob& job, const RunInfos& infos) {
  Checked<std::vector<BagRun>> result;
  std::vector<BagRun> runs;
  const std::string& topic = *infos.topics.begin();
  for (const auto& [time, info] : infos.runs) {
    Checked<Settings> settings =
        loadRecorded(configDirectory(), info.parameters_yaml, job.robot_description.value_or(info.robot_description));
    for (const std::string& problem : settings.problems) addOnce(result.problems, topic + ": " + problem);
    if (!settings.value) continue;
    addOnce(result.notes, "parameters of " + topic + " are used (version " + onOneLine(info.version) + ", revision " +
                              onOneLine(info.revision) + "); --params FILE.yaml replaces them");
    for (const std::string& note : settings.notes) addOnce(result.notes, topic + ": " + note);
    for (const std::string& note : settings.value->notes) addOnce(result.notes, note);
    runs.push_back({time, withTopics(*std::move(settings.value), job.topics)});
  }
  if (!result.problems.empty()) {
    result.problems.push_back(topic + ": its parameters cannot be used, --params FILE.yaml must give others");
    return result;
  }
  // If the node ran before the recording began, its run continues. Otherwise earlier messages are a run of their own.
  const std::optional<ros::Time> first = firstInput(inputs, runs.front().settings);
  if (first && infos.runs.front().info.header.stamp > *first) runs.insert(runs.begin(), runs.front());
  runs.front().from = ros::Time();
  result.value = std::move(runs);
  return result;
}

/// Runs with which a bag begins and ends; empty: unknown.
struct SplitRuns {
  std::size_t file{};
  std::string first, last;
  ros::Time begin, end;  ///< record times of its first and last message
};

SplitRuns splitRunsOf(const std::string& file, std::size_t index) {
  SplitRuns split{index, {}, {}, {}, {}};
  try {
    const Checked<BagInputs> inputs = BagInputs::open({file});
    if (!inputs.value) return split;
    std::vector<BagWarning> ignored;
    const RunInfos infos = readRunInfos(*inputs.value, ignored);
    std::tie(split.begin, split.end) = inputs.value->span();
    if (infos.topics.size() != 1) return split;
    const auto nameOf = [&](const RunInfo& info) {
      return sha256Of({*infos.topics.begin(), std::to_string(info.header.stamp.toNSec()), info.parameters_yaml,
                       info.robot_description});
    };
    split.first = nameOf(infos.runs.front().info);
    split.last = nameOf(infos.runs.back().info);
  } catch (const std::exception&) {  // processing reports the reason
    split.first.clear(), split.last.clear();
  }
  return split;
}

}  // namespace

std::vector<std::vector<std::string>> recordingsOf(const std::vector<std::string>& files) {
  std::vector<SplitRuns> splits;
  for (std::size_t i = 0; i < files.size(); ++i) splits.push_back(splitRunsOf(files[i], i));
  std::stable_sort(splits.begin(), splits.end(),
                   [](const SplitRuns& a, const SplitRuns& b) { return a.begin < b.begin; });
  std::vector<std::vector<std::size_t>> recordings;
  // Recording and end time of the last bag, by the run that ends it. Simultaneous recordings of one run are no splits.
  std::map<std::string, std::pair<std::size_t, ros::Time>> ended;
  const ros::Duration overlap(1.0);  // latched messages may be repeated with an earlier time
  for (const SplitRuns& split : splits) {
    const auto before = split.first.empty() ? ended.end() : ended.find(split.first);
    const bool goes_on = before != ended.end() && split.begin + overlap >= before->second.second;
    const std::size_t at = goes_on ? before->second.first : recordings.size();
    if (goes_on) ended.erase(before);
    if (!goes_on) recordings.emplace_back();
    recordings[at].push_back(split.file);
    if (!split.last.empty()) ended[split.last] = {at, split.end};
  }
  std::sort(recordings.begin(), recordings.end(), [](const auto& a, const auto& b) {
    return *std::min_element(a.begin(), a.end()) < *std::min_element(b.begin(), b.end());
  });
  std::vector<std::vector<std::string>> names;
  for (const std::vector<std::size_t>& recording : recordings) {
    names.emplace_back();
    for (const std::size_t file : recording) names.back().push_back(files[file]);
  }
  return names;
}

Checked<std::vector<BagRun>> runsOf(const BagInputs& inputs, const BagJob& job, std::vector<BagWarning>& warnings) {
  const RunInfos infos = readRunInfos(inputs, warnings);
  if (job.parameters || infos.runs.empty()) return runOfJob(job, infos, warnings);
  if (infos.topics.size() == 1) return recordedRuns(inputs, job, infos);
  return {std::nullopt,
          {inputs.names() + ": run_info of several hammers (" + joined(infos.topics) +
           "), --params FILE.yaml must give the parameters that apply"},
          {}};
}

}  // namespace hammer_loads
