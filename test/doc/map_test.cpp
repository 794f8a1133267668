// The map of doc/architecture.md against what the rooms include.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace hammer_loads {
namespace {

using RoomNames = std::set<std::string>;
const std::filesystem::path kMapRoot = std::filesystem::path(HAMMER_LOADS_TEST_DATA) / "../..";

RoomNames wordsOf(const std::string& text) {
  static const std::regex kWord("[a-z]+");
  return {std::sregex_token_iterator(text.begin(), text.end(), kWord), {}};
}

/// Rooms from the lowest up, and what each one's row says that it knows.
struct RoomMap {
  std::vector<std::string> order;
  std::map<std::string, RoomNames> knows;  ///< with what these know in turn, and itself

  RoomMap() {
    std::ifstream file(kMapRoot / "doc/architecture.md");
    const std::regex row(R"(\| `(\w+)` \| [^|]+ \| [^|]+ \| ([^|;]*)(?:;[^|]*)?\|)");
    for (std::string line; std::getline(file, line);) {
      std::smatch found;
      if (!std::regex_match(line, found, row)) continue;
      const std::string room = found[1];
      RoomNames& known = knows[room];
      const RoomNames said = wordsOf(found[2]);
      for (const std::string& lower : order)
        if (said.count(lower) == 1 || said.count("all") == 1) known.insert(knows[lower].begin(), knows[lower].end());
      known.insert(room);
      order.push_back(room);
    }
  }
};

RoomNames includedBy(const std::filesystem::path& folder) {
  RoomNames rooms;
  const std::regex include("#include \"hammer_loads/(\\w+)/");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string type = entry.path().extension();
    if (type != ".h" && type != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      std::smatch found;
      if (std::regex_search(line, found, include)) rooms.insert(found[1]);
    }
  }
  return rooms;
}

TEST(RoomMap, HasARowForEveryFolder) {
  const RoomMap map;
  for (const auto& entry : std::filesystem::directory_iterator(kMapRoot / "src/hammer_loads"))
    EXPECT_EQ(map.knows.count(entry.path().filename()), 1U) << entry.path();
}

/// A row further down would not be in `knows`: arrows go up the table only.
TEST(RoomMap, EveryRoomKnowsWhatItIncludes) {
  const RoomMap map;
  ASSERT_GT(map.order.size(), 10U);
  for (const std::string& room : map.order) {
    for (const std::string& included : includedBy(kMapRoot / "src/hammer_loads" / room))
      EXPECT_EQ(map.knows.at(room).count(included), 1U) << room << " includes " << included;
  }
}

}  // namespace
}  // namespace hammer_loads
