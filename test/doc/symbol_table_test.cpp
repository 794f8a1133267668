// The symbols of doc/model.md against papers, code, parameter files, messages and CSV columns.
#include <algorithm>

#include "doc/pages.h"
#include "hammer_loads/settings/load.h"

namespace hammer_loads {
namespace {

using namespace test;  // pages.h

/// The symbol table of doc/model.md: symbols here and in the papers, C++, YAML, and message or CSV names.
struct SymbolNames {
  std::vector<std::string> symbols, in_papers;
  Names cpp, yaml, messages, columns;
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) {
    const std::size_t first = part.find_first_not_of(' ');
    parts.push_back(first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(' ') - first + 1));
  }
  return parts;
}

SymbolNames symbolNames() {
  SymbolNames names;
  std::istringstream stream(section(textOf("doc/model.md"), "## 8. Symbols"));
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| ", 0) != 0 || line.rfind("| symbol", 0) == 0) continue;
    const Cells cells = split(line.substr(1), '|');
    EXPECT_EQ(cells.size(), 7U) << line;
    if (cells.size() != 7U) continue;
    for (const std::string& symbol : split(cells[0], ',')) names.symbols.push_back(symbol);
    std::string paper;  // a symbol without one is of the paper before it
    for (const std::string& symbol : split(cells[1], ',')) {
      if (symbol.empty()) continue;
      const bool named = symbol.rfind("P0 ", 0) == 0 || symbol.rfind("P1 ", 0) == 0;
      if (named) paper = symbol.substr(0, 3);
      names.in_papers.push_back(named ? symbol : paper + symbol);
    }
    names.cpp.merge(matches(cells[4], "`([^`]+)`"));
    names.yaml.merge(matches(cells[5], "`([^`]+)`"));
    names.messages.merge(matches(cells[6], "`(\\w+\\.\\w+)`"));
    names.columns.merge(matches(cells[6], "`evaluate: (\\w+)`"));
  }
  return names;
}

TEST(SymbolTable, HoldsEachSymbolOnce) {
  const SymbolNames names = symbolNames();
  EXPECT_GT(names.symbols.size(), 80U);
  EXPECT_EQ(Names(names.symbols.begin(), names.symbols.end()).size(), names.symbols.size());
  EXPECT_EQ(std::count(names.symbols.begin(), names.symbols.end(), ""), 0);
  EXPECT_GT(names.in_papers.size(), 40U);
  EXPECT_EQ(Names(names.in_papers.begin(), names.in_papers.end()).size(), names.in_papers.size());
}

/// Formulas of sections 1 to 5: lines of four spaces outside of pictures.
std::vector<std::string> formulas() {
  const std::string model = textOf("doc/model.md");
  std::vector<std::string> lines;
  std::istringstream stream(model.substr(0, model.find("\n## 6.")));
  bool is_picture = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("```", 0) == 0) is_picture = !is_picture;
    if (!is_picture && line.rfind("    ", 0) == 0) lines.push_back(line);
  }
  return lines;
}

TEST(SymbolTable, HoldsEverySymbolOfTheFormulas) {
  const std::vector<std::string> rows = symbolNames().symbols;
  Names known(rows.begin(), rows.end());
  for (const std::string& symbol : rows)  // psi'- is psi' at an instant
    if (symbol.back() == '-' || symbol.back() == '+') known.insert(symbol.substr(0, symbol.size() - 1));
  const Names words{"sin", "cos", "tan", "sgn", "int", "dt", "for", "else", "pi", "x", "y"};
  std::size_t seen = 0;
  for (const std::string& line : formulas()) {
    for (std::string symbol : matches(line, "([A-Za-z][A-Za-z0-9]*'*)")) {
      ++seen;
      if (known.count(symbol) == 0U) symbol = std::regex_replace(symbol, std::regex("^d2?|2$"), "");  // dpsi, dphi2
      EXPECT_TRUE(known.count(symbol) == 1U || words.count(symbol) == 1U) << symbol << " in:" << line;
    }
  }
  EXPECT_GT(seen, 150U);
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
    const bool is_std = key.find("_std") != std::string::npos ||
                        key.find("_std_") != std::string::npos;  // of a symbol that has its row
    EXPECT_TRUE(is_std || names.count(key) == 1U) << key;
  }
  merge(readParameterFile((kRoot / "config/pipeline.yaml").string(), problems).value(), parameters);
  for (const std::string& name : names) EXPECT_EQ(parameters.count(name), 1U) << name;
}

TEST(SymbolTable, HoldsEveryNumberOfTheMessagesItNames) {
  const Names names = symbolNames().messages;
  Names messages, fields;
  for (const std::string& name : names) messages.insert(name.substr(0, name.find('.')));
  for (const char* message : {"Blow", "PinForces", "Pulse"}) EXPECT_EQ(messages.count(message), 1U) << message;
  for (const std::string& message : messages) {
    for (const std::string& field : matches(textOf("msg/" + message + ".msg"), "float64 (\\w+)")) {
      const bool is_std = field.find("_std") != std::string::npos;  // of a number that has its row
      if (!is_std || names.count(message + "." + field) == 1U) fields.insert(message + "." + field);
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

/// A key is a name and a year, or one of the three papers.
TEST(References, HoldEveryWorkThatTheDocumentsCite) {
  const Names keys = matches(textOf("doc/references.bib"), "@\\w+\\{(\\w+),");
  EXPECT_GT(keys.size(), 20U);
  const std::string texts = textBelow("doc", ".md") + textOf("README.md");
  Names cited = matches(texts, "\\b([a-z]{3,}(?:19|20)\\d\\d)\\b");
  cited.merge(matches(textOf("doc/paper.md"), "@(\\w+)"));
  EXPECT_GT(cited.size(), 15U);
  for (const std::string& key : cited) EXPECT_EQ(keys.count(key), 1U) << key;
}

}  // namespace
}  // namespace hammer_loads
