// README.md, doc/api.md and doc/parameters.md against what they speak of: parameter files, topics, messages, commands.
#include <algorithm>

#include "doc/pages.h"
#include "hammer_loads/grapple_ros/grapple_outputs.h"
#include "hammer_loads/ros/hammer_outputs.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

using namespace test;  // pages.h

/// Rows of a section's tables whose first cell is in backquotes, the cells without spaces around them.
std::vector<Cells> tableRows(const std::string& text) {
  std::vector<Cells> rows;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    Cells cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const std::size_t first = cell.find_first_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
    }
    rows.push_back(cells);
  }
  return rows;
}

std::string withoutBackquotes(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
  return text;
}

/// As a table shows it.
std::string shown(const YAML::Node& value) {
  if (!value.IsSequence()) return value.Scalar();
  std::string list;
  for (const YAML::Node& item : value) list += (list.empty() ? "" : ", ") + item.Scalar();
  return "[" + list + "]";
}

TEST(Parameters, TablesHoldEachOneWithItsShippedValue) {
  const std::string readme = textOf("doc/parameters.md");
  for (const std::string file : {"config/hammer_mo100.yaml", "config/pipeline.yaml", "config/log.yaml",
                                 "config/life.yaml", "config/limits.yaml", "config/grapple_node.yaml"}) {
    std::vector<std::string> problems;
    const ParameterMap parameters = readParameterFile((kRoot / file).string(), problems).value();
    std::istringstream headings(readme);
    std::string heading;
    while (std::getline(headings, heading) && (heading[0] != '#' || heading.find(file) == std::string::npos)) {
    }
    Names on_page;
    for (const Cells& row : tableRows(section(readme, heading))) {
      const std::string key = withoutBackquotes(row[0]);
      on_page.insert(key);
      const auto found = parameters.find(key);
      if (found == parameters.end()) {
        ADD_FAILURE() << key << " is in doc/parameters.md, but not in " << file;
      } else {
        EXPECT_EQ(row[1], shown(found->second.value)) << key;
      }
    }
    for (const auto& [key, parameter] : parameters)
      EXPECT_EQ(on_page.count(key), 1U) << key << " of " << file << " is not in doc/parameters.md";
  }
}

/// What a table of outputs publishes, and what its node takes.
template <typename Outputs>
Names topicsOf(Outputs outputs, Names inputs) {
  outputs.forEach([&inputs](const auto& output) { inputs.insert("~" + output.name()); });
  inputs.insert("/diagnostics");
  return inputs;
}

/// First cells of a section's tables; JAW in one stands for left and right.
Names topicsInTables(const std::string& heading) {
  Names topics;
  for (const Cells& row : tableRows(section(textOf("doc/api.md"), heading))) {
    const std::string topic = withoutBackquotes(row[0]);
    for (const char* jaw : {"left", "right"}) topics.insert(std::regex_replace(topic, std::regex("JAW"), jaw));
  }
  return topics;
}

TEST(Api, TablesHoldEveryTopicOfTheNodes) {
  HammerOutputs outputs;
  outputs.boom_wrench.emplace_back("boom_wrench/LINK");
  Names inputs;
  for (const InputName& input : kInputs) inputs.insert(input.name);
  EXPECT_EQ(topicsInTables("## Topics"), topicsOf(outputs, inputs));
  const Names grapple = topicsOf(GrappleOutputs{}, {"joint_states"});
  EXPECT_EQ(topicsInTables("### Grapple\n"), grapple);
}

TEST(Api, TableHoldsEveryMessage) {
  Names messages;
  for (const auto& entry : fs::directory_iterator(kRoot / "msg")) messages.insert(entry.path().stem().string());
  Names on_page;
  for (const Cells& row : tableRows(section(textOf("doc/api.md"), "## Messages")))
    on_page.insert(withoutBackquotes(row[0]));
  EXPECT_EQ(on_page, messages);
}

TEST(Api, HoldsEveryCommandAndNode) {
  const std::string commands = section(textOf("doc/api.md"), "## Commands");
  for (const auto& entry : fs::directory_iterator(kRoot / "src/hammer_loads/commands")) {
    const std::string name = entry.path().stem().string();
    const std::size_t end = name.rfind("_main");
    if (end == std::string::npos) continue;
    EXPECT_NE(commands.find("`" + name.substr(0, end)), std::string::npos) << name;
  }
  const Names python = matches(textOf("src/hammer_loads/commands/report_main.py"), "\"(\\w+)\": \"\\w+\"");
  EXPECT_EQ(python.size(), 4U);
  for (const std::string& name : python) EXPECT_NE(commands.find("`" + name), std::string::npos) << name;
  for (const Cells& row : tableRows(commands)) {
    const std::string name = withoutBackquotes(row[0]).substr(0, withoutBackquotes(row[0]).find(' '));
    EXPECT_TRUE(fs::exists(kRoot / "src/hammer_loads/commands" / (name + "_main.cpp")) || python.count(name) == 1)
        << name;
  }
}

TEST(Api, EveryOptionOfItsCommandsExists) {
  const std::string sources = textBelow("src/hammer_loads", ".cpp") + textBelow("src/hammer_loads", ".py");
  for (const Cells& row : tableRows(section(textOf("doc/api.md"), "## Commands"))) {
    for (const std::string& option : matches(row[0] + row[1], "(--[a-z-]+)"))
      EXPECT_NE(sources.find("\"" + option + "\""), std::string::npos) << option;
  }
}

TEST(Readme, EveryFileItNamesExists) {
  const std::string page = textOf("README.md");
  for (const std::string& path : matches(page, "\\]\\(([\\w./]+)\\)")) {
    if (path == "doc/demo.png") continue;  // made by scripts/demo
    EXPECT_TRUE(fs::exists(kRoot / path)) << path;
  }
  const std::string readme = page + textOf("doc/api.md");
  for (const std::string& path : matches(readme, "((?:config|launch|scripts)/\\w[\\w.]*)"))
    EXPECT_TRUE(fs::exists(kRoot / path)) << path;
  for (const std::string& path : matches(readme, "(hammer_loads/\\w+/\\w+\\.h)"))
    EXPECT_TRUE(fs::exists(kRoot / "src" / path)) << path;
  for (const std::string& path : matches(readme, "hammer_loads (\\w+\\.launch)"))
    EXPECT_TRUE(fs::exists(kRoot / "launch" / path)) << path;
}

}  // namespace
}  // namespace hammer_loads
