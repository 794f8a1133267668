#include "hammer_loads/ros/ros_parameters.h"

#include <gtest/gtest.h>

#include <limits>

#include "hammer_loads/settings/yaml_value.h"

namespace hammer_loads {
namespace {

using XmlRpc::XmlRpcValue;
using Lines = std::vector<std::string>;

Lines problemsOnServer(const XmlRpcValue& parameters) {
  Lines problems;
  const ParameterMap map = parameterMap(yamlFromXmlRpc(parameters), "/node", problems).value();
  const Lines found = load(configDirectory(), map).problems;
  problems.insert(problems.end(), found.begin(), found.end());
  return problems;
}

TEST(RosParameters, KeepsTypesAndValues) {
  EXPECT_EQ(asBoolean(yamlFromXmlRpc(XmlRpcValue(true))), true);
  EXPECT_EQ(asInteger(yamlFromXmlRpc(XmlRpcValue(-7))), -7);
  for (const double number : {0.1, 1.0 / 3.0, -5e-324, 1.7976931348623157e308, 3.0})
    EXPECT_EQ(asNumber(yamlFromXmlRpc(XmlRpcValue(number))), number);
  EXPECT_FALSE(asInteger(yamlFromXmlRpc(XmlRpcValue(3.0))).has_value());
  for (const char* text : {"word", "1.5", "true", ""}) {
    EXPECT_EQ(asText(yamlFromXmlRpc(XmlRpcValue(text))), text);
    EXPECT_FALSE(asNumber(yamlFromXmlRpc(XmlRpcValue(text))).has_value());
  }
}

TEST(RosParameters, ReachTheFilesReaderWhoseProblemsNameTheNameSpace) {
  XmlRpcValue parameters;
  parameters["tolerance"] = 1;
  parameters["crank_stamps"] = "steady";
  parameters["pitch_joints"][0] = "boom_joint";
  parameters["gravity_m_s2"] = "9.8";
  parameters["hull_pitch_rad"] = std::numeric_limits<double>::quiet_NaN();
  parameters["stale_after_s"] = -1.5;
  parameters["excavator"]["length_m"] = 3.0;
  EXPECT_EQ(problemsOnServer(parameters), (Lines{"hull_pitch_rad: .nan rad, must be a number in [-6.3, 6.3] (/node)",
                                                 "gravity_m_s2: \"9.8\" m/s2, must be a number in [0.0, 100.0] (/node)",
                                                 "stale_after_s: -1.5 s, must be a number in [0.001, 10.0] (/node)",
                                                 "excavator: unknown key (/node)"}));
}

}  // namespace
}  // namespace hammer_loads
