// Tests that constants name as their guards: `// Guard: Suite.Test of kName, kName`, of limits `// Limit: ...`. Whether
// they notice is asked by scripts/sensitivity.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
const fs::path kGuardRoot = fs::path(HAMMER_LOADS_TEST_DATA) / "../..";

std::string wholeText(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Matches of the files below a folder, the groups joined by a dot.
std::set<std::string> namesBelow(const fs::path& folder, const std::regex& pattern) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    const std::string text = wholeText(entry.path());
    for (std::sregex_iterator found(text.begin(), text.end(), pattern), end; found != end; ++found)
      names.insert((*found)[1].str() + "." + (*found)[2].str());
  }
  return names;
}

TEST(Guards, AreTests) {
  const std::set<std::string> tests =
      namesBelow(kGuardRoot / "test", std::regex("TEST(?:_[FP])?\\((\\w+),\\s*(\\w+)\\)"));
  const std::set<std::string> guards =
      namesBelow(kGuardRoot / "src", std::regex("// (?:Guard|Limit): (?:\\w+/)?(\\w+)\\.(\\w+)"));
  ASSERT_GT(guards.size(), 10U);
  for (const std::string& guard : guards) EXPECT_EQ(tests.count(guard), 1U) << guard;
}

/// scripts/sensitivity reads them from the environment, which no function that is constexpr can.
TEST(Guards, AreOfConstantsThatCanBeChanged) {
  const std::regex guard("// (?:Guard|Limit): [^\\n]* of ([\\w, ]+)"), name("k[A-Z]\\w*");
  const std::regex function("constexpr\\s+[\\w:<>*& ]*\\w\\([^)]*\\)[^;{]*\\{[^}]*\\}");
  std::size_t functions = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kGuardRoot / "src")) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    const std::string text = wholeText(entry.path());
    std::set<std::string> guarded;
    for (std::sregex_iterator found(text.begin(), text.end(), guard), end; found != end; ++found) {
      const std::string names = (*found)[1];
      for (std::sregex_iterator one(names.begin(), names.end(), name); one != end; ++one) guarded.insert(one->str());
    }
    if (guarded.empty()) continue;
    for (std::sregex_iterator found(text.begin(), text.end(), function), end; found != end; ++found) {
      const std::string of = found->str();
      ++functions;
      for (std::sregex_iterator one(of.begin(), of.end(), name); one != end; ++one)
        EXPECT_EQ(guarded.count(one->str()), 0U) << entry.path() << ": " << of;
    }
  }
  EXPECT_GT(functions, 2U);
}

}  // namespace
}  // namespace hammer_loads
