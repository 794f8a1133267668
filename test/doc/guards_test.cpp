// Tests that constants name as their guards: `// Guard: Suite.Test of kName, kName`, of priors `// Prior: ...`, of
// limits `// Limit: ...`. Whether they notice is asked by scripts/sensitivity.
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

/// use(path, text) of each file of C++ below a folder.
template <typename Use>
void forEachSource(const fs::path& folder, const Use& use) {
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
      use(entry.path(), wholeText(entry.path()));
}

/// use(match) of each in a text.
template <typename Use>
void forEachMatch(const std::string& text, const std::regex& pattern, const Use& use) {
  for (std::sregex_iterator found(text.begin(), text.end(), pattern), end; found != end; ++found) use(*found);
}

/// Matches of the files below a folder, the groups joined by a dot.
std::set<std::string> namesBelow(const fs::path& folder, const std::regex& pattern) {
  std::set<std::string> names;
  forEachSource(folder, [&](const fs::path&, const std::string& text) {
    forEachMatch(text, pattern, [&](const std::smatch& found) { names.insert(found[1].str() + "." + found[2].str()); });
  });
  return names;
}

TEST(Guards, AreTests) {
  const std::set<std::string> tests =
      namesBelow(kGuardRoot / "test", std::regex("TEST(?:_[FP])?\\((\\w+),\\s*(\\w+)\\)"));
  const std::set<std::string> guards =
      namesBelow(kGuardRoot / "src", std::regex("// (?:Guard|Limit|Prior): (?:\\w+/)?(\\w+)\\.(\\w+)"));
  ASSERT_GT(guards.size(), 10U);
  for (const std::string& guard : guards) EXPECT_EQ(tests.count(guard), 1U) << guard;
}

/// scripts/sensitivity reads them from the environment, which no function that is constexpr can.
TEST(Guards, AreOfConstantsThatCanBeChanged) {
  const std::regex guard("// (?:Guard|Limit|Prior): [^\\n]* of ([\\w, ]+)"), name("k[A-Z]\\w*");
  const std::regex function("constexpr\\s+[\\w:<>*& ]*\\w\\([^)]*\\)[^;{]*\\{[^}]*\\}");
  std::size_t functions = 0;
  forEachSource(kGuardRoot / "src", [&](const fs::path& path, const std::string& text) {
    std::set<std::string> guarded;
    forEachMatch(text, guard, [&](const std::smatch& found) {
      forEachMatch(found[1].str(), name, [&](const std::smatch& one) { guarded.insert(one.str()); });
    });
    if (guarded.empty()) return;
    forEachMatch(text, function, [&](const std::smatch& found) {
      ++functions;
      forEachMatch(found.str(), name, [&](const std::smatch& one) {
        EXPECT_EQ(guarded.count(one.str()), 0U) << path << ": " << found.str();
      });
    });
  });
  EXPECT_GT(functions, 2U);
}

}  // namespace
}  // namespace hammer_loads
