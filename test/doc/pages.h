/// Texts of the source tree, for tests of what they say.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace hammer_loads::test {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

inline const fs::path kRoot = fs::path(HAMMER_LOADS_TEST_DATA) / ".." / "..";

inline std::string textOf(const fs::path& path) {
  std::ifstream file(kRoot / path);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// All texts of files with an ending below a folder.
inline std::string textBelow(const fs::path& folder, const std::string& ending) {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    if (entry.path().extension() == ending) text += textOf(fs::relative(entry.path(), kRoot));
  }
  return text;
}

/// First groups of all matches.
inline Names matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  Names found;
  for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i) found.insert((*i)[1]);
  return found;
}

/// From a heading that begins so to the next heading.
inline std::string section(const std::string& text, const std::string& heading) {
  const std::size_t begin = text.find("\n" + heading);
  EXPECT_NE(begin, std::string::npos) << heading;
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find("\n#", begin + heading.size()) - begin);
}

using Cells = std::vector<std::string>;

}  // namespace hammer_loads::test
