/// process_grapple: a recording in, the grapple's motion out.
#include <console_bridge/console.h>

#include <iostream>
#include <system_error>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/commands/progress_bar.h"
#include "hammer_loads/grapple_ros/grapple_flow.h"
#include "hammer_loads/ros/bag_inputs.h"
#include "hammer_loads/ros/output.h"
#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

struct Arguments {
  std::vector<std::string> bags, params;  ///< bags: inputs, then the output
  std::string topic{"/joint_states"}, prefix{"/grapple"};
  bool force{};
};

/// Reasons of the samples that gave no jaw edge, one line each; empty if all did.
std::string refusalReport(const GrappleFlow& flow) {
  std::string report;
  for (const RefusalCount& refusal : flow.refusals()) {
    if (refusal.count == 0) continue;
    report += "slider samples without a jaw edge, " + refusal.reason + ": " + std::to_string(refusal.count);
    report += refusal.last.empty() ? "\n" : "; the last one: " + refusal.last + "\n";
  }
  if (flow.withoutVelocity() > 0)
    report +=
        "slider samples without a velocity, so without twist and accel: " + std::to_string(flow.withoutVelocity()) +
        "\n";
  return report;
}

/// Reason why the topic cannot be read, one line; empty: it can.
std::string topicProblem(const BagInputs& inputs, const std::string& topic) {
  if (!inputs.has(topic)) return "no topic " + topic + ", is required; topics there: " + inputs.topicList();
  for (const std::string& type : inputs.topics().at(topic).types)
    if (type != typeOf<sensor_msgs::JointState>())
      return topic + " is of type " + onOneLine(type) + ", must be " + typeOf<sensor_msgs::JointState>();
  return {};
}

/// Processes the bag. Returns the error, one line; empty: none.
std::string process(const BagInputs& inputs, const Arguments& given, const std::string& output, GrappleFlow& flow) {
  try {
    BagWriter bag(output);
    attachToBag(flow.outputs(), bag, given.prefix, false);
    ProgressBar bar;
    BagMessages messages = inputs.messagesOn({given.topic});
    double done = 0.0;
    sensor_msgs::JointState slider;
    while (const BagMessage* item = messages.next()) {
      bar(++done / static_cast<double>(messages.size()));
      item->to(slider);
      flow.jointStates(slider, item->time);
    }
    bag.close();
    if (flow.accepted() == 0) return inputs.names() + ": no jaw edge; " + onOneLine(refusalReport(flow));
    return {};
  } catch (const std::system_error& error) {  // an error of an input is none of the output
    return given.bags.back() + ": cannot be written: " + error.code().message();
  } catch (const std::exception& error) {
    return inputs.names() + ": cannot be read: " + onOneLine(error.what());
  }
}

int run(int argc, const char* const* argv) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);  // rosbag formats a line for every message
  CommandLine line("Motion of the grapple from a recorded bag", "process_grapple");
  Arguments given;
  line.add_option("bags", given.bags,
                  "IN.bag... OUT.bag: the bags of one recording, then the bag to write, which must not exist")
      ->required()
      ->expected(2, 1000000);
  addParamsOption(line, given.params)
      ->required()
      ->description("the grapple, over the shipped grapple_node.yaml; may be repeated");
  line.add_option("--joint-states-topic", given.topic, "with the slider's joint")
      ->type_name("TOPIC")
      ->capture_default_str();
  line.add_option("--output-prefix", given.prefix, "of every topic written")->capture_default_str();
  line.add_flag("--force", given.force, "replace OUT.bag if it holds results of this package alone");
  if (const auto code = line.parse(argc, argv)) return *code;
  endCleanlyOnSignals();
  const std::vector<std::string> bags(given.bags.begin(), given.bags.end() - 1);
  const Checked<GrappleSettings> settings = loadGrappleSettings(configDirectory(), given.params);
  if (!settings.value) return fail(settings.problems);
  const Checked<BagInputs> inputs = BagInputs::open(bags);
  if (!inputs.value) return fail(inputs.problems);
  const std::string problem = topicProblem(*inputs.value, given.topic);
  if (!problem.empty()) return fail({inputs.value->names() + ": " + problem});
  const auto keep = [&given](const std::string& name) { return whyBagMustStay(name, {given.topic}); };
  Checked<OutputFile> file = OutputFile::make({given.bags.back(), bags, given.force, keep});
  if (!file.value) return fail(file.problems);
  GrappleFlow flow(*settings.value);
  std::string failure = process(*inputs.value, given, file.value->path(), flow);
  if (failure.empty()) failure = file.value->publish();
  if (!failure.empty()) return fail({failure});
  std::cerr << refusalReport(flow);
  std::cout << given.bags.back() << ": " << flow.accepted() << " slider samples with jaw edges, written under "
            << given.prefix << std::endl;
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
