// Sources are built thirty in one here, and each alone where a user builds them: what one names must be its own or in a
// header that it includes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

bool isName(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Names, and all other characters one by one, without comments and literals.
Words wordsOfCode(const std::string& text) {
  Words words;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i), text.size() - 2) + 2;
    } else if (text[i] == '"' || (text[i] == '\'' && (i == 0 || !isName(text[i - 1])))) {
      const char quote = text[i];
      for (++i; i < text.size() && text[i] != quote; ++i) i += text[i] == '\\';
      ++i;
    } else if (isName(text[i])) {
      const std::size_t begin = i;
      while (i < text.size() && isName(text[i])) ++i;
      words.push_back(text.substr(begin, i - begin));
    } else {
      if (std::isspace(static_cast<unsigned char>(text[i])) == 0) words.emplace_back(1, text[i]);
      ++i;
    }
  }
  return words;
}

/// Names of constants and of types as this project writes them: kMostSpeed, CrankFilter.
bool isOurs(const std::string& word) {
  const std::size_t first = word[0] == 'k' ? 1 : 0;
  return word.size() > first + 1 && std::isupper(static_cast<unsigned char>(word[first])) != 0 &&
         std::islower(static_cast<unsigned char>(word[first + 1])) != 0;
}

struct Source {
  std::set<std::string> names, declared, includes, messages;
};

/// names: without those that are another name's (after ::, . or ->). declared: types, aliases, parameters of templates,
/// enumerators; constants where something is assigned to them.
Source sourceOf(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  Source source;
  for (std::string line; std::getline(file, line); text << line << '\n') {
    const std::string begin = "#include \"";
    if (line.rfind(begin, 0) == 0)
      source.includes.insert(line.substr(begin.size(), line.find('"', begin.size()) - begin.size()));
    if (line.rfind("#include <", 0) == 0) source.messages.insert(fs::path(line.substr(0, line.find('>'))).stem());
  }
  bool in_enum = false;
  const Words words = wordsOfCode(text.str());
  const auto at = [&](std::size_t i) { return i < words.size() ? words[i] : std::string(); };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string &word = words[i], before = at(i - 1), after = at(i + 1);
    if (word == "enum") in_enum = true;
    if (word == "}" || word == ";") in_enum = false;
    const bool is_pack = before == "." && at(i - 2) == ".";
    const bool of_another = (before == "." && !is_pack) || before == ":" || (before == ">" && at(i - 2) == "-");
    const bool is_suite = before == "(" && at(i - 2).find("TEST") != std::string::npos;
    if (!isOurs(word) || of_another || is_suite) continue;
    source.names.insert(word);
    const bool of_type =
        !before.empty() && before != "return" && (isName(before.back()) || std::string(">*&").find(before) < 3);
    const bool is_set = (after == "=" && at(i + 2) != "=") || (after == "[" && at(i + 2) == "]") ||
                        (before == "," && after == "(") || (of_type && (after == "[" || after == "{" || after == "("));
    const bool is_parameter =
        (before == "typename" || before == "int" || is_pack) && (after == "," || after == ">" || after == "=");
    if (before == "struct" || before == "class" || before == "enum" || in_enum || is_parameter ||
        (before == "using" && after == "=") || (word[0] == 'k' && is_set))
      source.declared.insert(word);
  }
  return source;
}

using Sources = std::map<std::string, Source>;  ///< by path below src

void addIncluded(const Sources& sources, const std::string& path, std::set<std::string>& seen) {
  const auto source = sources.find(path);
  if (source == sources.end() || !seen.insert(path).second) return;
  for (const std::string& next : source->second.includes) addIncluded(sources, next, seen);
}

/// "file: name" of every name that neither the file nor a header that it includes has.
std::set<std::string> strangersIn(const Sources& sources) {
  std::set<std::string> of_project, strangers;
  for (const auto& [path, source] : sources) of_project.insert(source.declared.begin(), source.declared.end());
  for (const auto& [path, source] : sources) {
    std::set<std::string> seen, known = source.declared;
    known.insert(source.messages.begin(), source.messages.end());
    addIncluded(sources, path, seen);
    seen.erase(path);
    for (const std::string& next : source.includes) known.insert(fs::path(next).stem());  // a message, say
    for (const std::string& header : seen)
      for (const auto* of : {&sources.at(header).names, &sources.at(header).messages})
        known.insert(of->begin(), of->end());
    for (const std::string& name : source.names)
      if (of_project.count(name) == 1 && known.count(name) == 0) strangers.insert(path + ": " + name);
  }
  return strangers;
}

void addSourcesBelow(const fs::path& root, Sources& sources) {
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string type = entry.path().extension(), room = entry.path().parent_path().filename();
    if ((type == ".h" || type == ".cpp") && room != "use_readme")
      sources[fs::relative(entry.path(), root)] = sourceOf(entry.path());
  }
}

TEST(Includes, EverySourceStandsAlone) {
  Sources sources;
  for (const char* folder : {"src", "test"})
    addSourcesBelow(fs::path(HAMMER_LOADS_TEST_DATA) / "../.." / folder, sources);
  ASSERT_GT(sources.size(), 700U);
  EXPECT_EQ(strangersIn(sources), std::set<std::string>{});
}

/// The channel: what was borrowed from the source before it in the same build.
TEST(Includes, ABorrowedNameIsFound) {
  Source lender, borrower;
  lender.names = lender.declared = {"kZeroLimit"};
  borrower.names = {"kZeroLimit"};
  EXPECT_EQ(strangersIn({{"a.cpp", lender}, {"b.cpp", borrower}}), std::set<std::string>{"b.cpp: kZeroLimit"});
  borrower.includes = {"a.h"};
  EXPECT_EQ(strangersIn({{"a.h", lender}, {"b.cpp", borrower}}), std::set<std::string>{});
}

}  // namespace
}  // namespace hammer_loads
