// README.md and doc/model.md against what they speak of: parameter files, topics, messages, commands, C++ names.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "hammer_loads/grapple_ros/grapple_outputs.h"
#include "hammer_loads/ros/hammer_outputs.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path kRoot = fs::path(HAMMER_LOADS_TEST_DATA) / ".." / "..";

std::string textOf(const fs::path& path) {
  std::ifstream file(kRoot / path);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// All texts of files with an ending below a folder.
std::string textBelow(const fs::path& folder, const std::string& ending) {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    if (entry.path().extension() == ending) text += textOf(fs::relative(entry.path(), kRoot));
  }
  return text;
}

/// First groups of all matches.
Names matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  Names found;
  for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i) found.insert((*i)[1]);
  return found;
}

/// From a heading that begins so to the next heading.
std::string section(const std::string& text, const std::string& heading) {
  const std::size_t begin = text.find("\n" + heading);
  EXPECT_NE(begin, std::string::npos) << heading;
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find("\n#", begin + heading.size()) - begin);
}

using Cells = std::vector<std::string>;

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
                                 "config/life.yaml", "config/grapple_node.yaml"}) {
    std::vector<std::string> problems;
    const ParameterMap parameters = readParameterFile((kRoot / file).string(), problems).value();
    std::istringstream headings(readme);
    std::string heading;
    while (std::getline(headings, heading) && (heading[0] != '#' || heading.find(file) == std::string::npos)) {
    }
    Names in_readme;
    for (const Cells& row : tableRows(section(readme, heading))) {
      const std::string key = withoutBackquotes(row[0]);
      in_readme.insert(key);
      const auto found = parameters.find(key);
      if (found == parameters.end()) {
        ADD_FAILURE() << key << " is in doc/parameters.md, but not in " << file;
      } else {
        EXPECT_EQ(row[1], shown(found->second.value)) << key;
      }
    }
    for (const auto& [key, parameter] : parameters)
      EXPECT_EQ(in_readme.count(key), 1U) << key << " of " << file << " is not in doc/parameters.md";
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
Names topicsInReadme(const std::string& heading) {
  Names topics;
  for (const Cells& row : tableRows(section(textOf("README.md"), heading))) {
    const std::string topic = withoutBackquotes(row[0]);
    for (const char* jaw : {"left", "right"}) topics.insert(std::regex_replace(topic, std::regex("JAW"), jaw));
  }
  return topics;
}

TEST(Readme, TablesHoldEveryTopicOfTheNodes) {
  HammerOutputs outputs;
  outputs.boom_wrench.emplace_back("boom_wrench/LINK");
  Names inputs;
  for (const InputName& input : kInputs) inputs.insert(input.name);
  EXPECT_EQ(topicsInReadme("## Topics"), topicsOf(outputs, inputs));
  const Names grapple = topicsOf(GrappleOutputs{}, {"joint_states"});
  EXPECT_EQ(topicsInReadme("### Grapple\n"), grapple);
}

TEST(Readme, TableHoldsEveryMessage) {
  Names messages;
  for (const auto& entry : fs::directory_iterator(kRoot / "msg")) messages.insert(entry.path().stem().string());
  Names in_readme;
  for (const Cells& row : tableRows(section(textOf("README.md"), "## Messages")))
    in_readme.insert(withoutBackquotes(row[0]));
  EXPECT_EQ(in_readme, messages);
}

TEST(Readme, HoldsEveryCommandAndNode) {
  const std::string commands = section(textOf("README.md"), "## Commands");
  for (const auto& entry : fs::directory_iterator(kRoot / "src/hammer_loads/commands")) {
    const std::string name = entry.path().stem().string();
    const std::size_t end = name.rfind("_main");
    if (end == std::string::npos) continue;
    EXPECT_NE(commands.find("`" + name.substr(0, end)), std::string::npos) << name;
  }
  const Names python = matches(textOf("src/hammer_loads/commands/report_main.py"), "\"(\\w+)\": \"\\w+\"");
  EXPECT_EQ(python.size(), 3U);
  for (const std::string& name : python) EXPECT_NE(commands.find("`" + name), std::string::npos) << name;
  for (const Cells& row : tableRows(commands)) {
    const std::string name = withoutBackquotes(row[0]).substr(0, withoutBackquotes(row[0]).find(' '));
    EXPECT_TRUE(fs::exists(kRoot / "src/hammer_loads/commands" / (name + "_main.cpp")) || python.count(name) == 1)
        << name;
  }
}

TEST(Readme, EveryOptionOfItsCommandsExists) {
  const std::string sources = textBelow("src/hammer_loads", ".cpp") + textBelow("src/hammer_loads", ".py");
  for (const Cells& row : tableRows(section(textOf("README.md"), "## Commands"))) {
    for (const std::string& option : matches(row[0] + row[1], "(--[a-z-]+)"))
      EXPECT_NE(sources.find("\"" + option + "\""), std::string::npos) << option;
  }
}

TEST(Readme, EveryFileItNamesExists) {
  const std::string readme = textOf("README.md");
  for (const std::string& path : matches(readme, "\\]\\(([\\w./]+)\\)")) {
    if (path == "doc/demo.png") continue;  // made by scripts/demo
    EXPECT_TRUE(fs::exists(kRoot / path)) << path;
  }
  for (const std::string& path : matches(readme, "((?:config|launch|scripts)/\\w[\\w.]*)"))
    EXPECT_TRUE(fs::exists(kRoot / path)) << path;
  for (const std::string& path : matches(readme, "(hammer_loads/\\w+/\\w+\\.h)"))
    EXPECT_TRUE(fs::exists(kRoot / "src" / path)) << path;
  for (const std::string& path : matches(readme, "hammer_loads (\\w+\\.launch)"))
    EXPECT_TRUE(fs::exists(kRoot / "launch" / path)) << path;
}

/// The symbol table of doc/model.md: C++, YAML, and message or CSV names.
struct SymbolNames {
  Names cpp, yaml, messages, columns;
};

SymbolNames symbolNames() {
  SymbolNames names;
  std::istringstream stream(section(textOf("doc/model.md"), "## 8. Symbols"));
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| ", 0) != 0) continue;
    Cells cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) cells.push_back(cell);
    if (cells.size() < 5) continue;
    names.cpp.merge(matches(cells[3], "`([^`]+)`"));
    names.yaml.merge(matches(cells[4], "`([^`]+)`"));
    if (cells.size() < 6) continue;
    names.messages.merge(matches(cells[5], "`(\\w+\\.\\w+)`"));
    names.columns.merge(matches(cells[5], "`evaluate: (\\w+)`"));
  }
  return names;
}

TEST(SymbolTable, EveryCppNameExists) {
  const Names words = matches(textBelow("src/hammer_loads", ".h"), "(\\w+)");
  const Names names = symbolNames().cpp;
  EXPECT_GT(names.size(), 50U);
  for (const std::string& name : names) {
    for (const std::string& part : matches(name, "(\\w+)")) EXPECT_EQ(words.count(part), 1U) << name;
  }
}

TEST(SymbolTable, EveryKeyExistsAndNoHammerKeyIsMissing) {
  const Names names = symbolNames().yaml;
  std::vector<std::string> problems;
  ParameterMap parameters = readParameterFile((kRoot / "config/hammer_mo100.yaml").string(), problems).value();
  for (const auto& [key, parameter] : parameters) {
    const bool is_deviation = key.find("_deviation") != std::string::npos;  // of a symbol that has its row
    EXPECT_TRUE(is_deviation || names.count(key) == 1U) << key;
  }
  merge(readParameterFile((kRoot / "config/pipeline.yaml").string(), problems).value(), parameters);
  for (const std::string& name : names) EXPECT_EQ(parameters.count(name), 1U) << name;
}

TEST(SymbolTable, HoldsEveryNumberOfTheMessagesItSpeaksOf) {
  const Names names = symbolNames().messages;
  Names messages, fields;
  for (const std::string& name : names) messages.insert(name.substr(0, name.find('.')));
  for (const char* message : {"Blow", "PinForces", "Pulse"}) EXPECT_EQ(messages.count(message), 1U) << message;
  for (const std::string& message : messages) {
    for (const std::string& field : matches(textOf("msg/" + message + ".msg"), "float64 (\\w+)")) {
      const bool is_deviation = field.find("_deviation") != std::string::npos;  // of a number that has its row
      if (!is_deviation || names.count(message + "." + field) == 1U) fields.insert(message + "." + field);
    }
  }
  EXPECT_EQ(names, fields);
}

TEST(SymbolTable, HoldsEveryColumnOfEvaluate) {
  const std::string sources =
      textOf("src/hammer_loads/hammer/evaluate.h") + textOf("src/hammer_loads/hammer/evaluate.cpp");
  const Names columns = matches(sources, "\"(\\w+_(?:rad|rad_s|rad_s2|m_s2|N|Nm))\"");
  EXPECT_EQ(columns.size(), 21U);
  EXPECT_EQ(symbolNames().columns, columns);
}

TEST(Model, EverySourceFileItNamesExists) {
  for (const std::string& path : matches(textOf("doc/model.md"), "`((?:linkage|hammer|crank)/\\w+\\.h)`"))
    EXPECT_TRUE(fs::exists(kRoot / "src/hammer_loads" / path)) << path;
}

}  // namespace
}  // namespace hammer_loads
