/// hammer_loads_node: the live node.
#include "hammer_loads/ros/hammer_outputs.h"
#include "hammer_loads/ros/live_node.h"
#include "hammer_loads/ros/run_node.h"
#include "hammer_loads/settings/input_topics.h"

namespace {

constexpr char kBegin[] =
    R"(Loads of a hydraulic hammer on its hull and boom, live. Needs a ROS master.
Usage: rosrun hammer_loads hammer_loads_node [NAME:=TOPIC]... [_KEY:=VALUE]...
       roslaunch hammer_loads hammer_loads.launch [ARG:=VALUE]...    (--ros-args lists them)

Topics in (remap them with NAME:=TOPIC)
)";
constexpr char kEnd[] = R"(
Services
  ~log/start ~log/stop ~log/split  std_srvs/Trigger
  ~set_parameters                  dynamic_reconfigure: log_enabled, output_rate_Hz, tolerance, withhold_above

Parameters (private; SI units, each explained in its file in the package's directory config)
  hammer_mo100.yaml    the hammer; one key given means that all must be
  pipeline.yaml        how samples become loads
  log.yaml             where and how to log
  life.yaml            which load cycles are counted; the ledger that keeps them
  boom_eo2621.yaml     cylinders and supports of a boom; without it the boom is rigid
  robot_description    URDF of the boom; without it there are no loads of the boom

  -h, --help  print this    --version  print the version
)";

std::string usage() {
  std::string text = kBegin;
  for (const hammer_loads::InputName& input : hammer_loads::kInputs) {
    const std::string name = input.name;
    text += "  " + name + std::string(name.size() < 13 ? 14 - name.size() : 2, ' ') + input.holds + "\n";
  }
  text +=
      "  /tf, /tf_static  where boom_wrench_links names frames outside the boom's chain\n\n"
      "Topics out (private: below the node's name)\n";
  hammer_loads::HammerOutputs outputs;
  outputs.boom_wrench.emplace_back("boom_wrench/LINK");
  outputs.forEach([&text](const auto& output) {
    using hammer_loads::Delivery;
    const bool latched = output.delivery() == Delivery::kLatched || output.delivery() == Delivery::kLast;
    text += "  ~" + output.name() + (latched ? " (latched)\n" : "\n");
  });
  return text + "  /diagnostics\n" + kEnd;
}

}  // namespace

int main(int argc, char** argv) {
  return hammer_loads::runNode(argc, argv, usage(), "hammer_loads", hammer_loads::makeHammerNode);
}
