/// Scripts explain themselves and then do nothing else.
#include <gtest/gtest.h>

#include <filesystem>

#include "support/command.h"

namespace hammer_loads::test {
namespace {

namespace fs = std::filesystem;

TEST(Scripts, EachExplainsItselfOnHelp) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(HAMMER_LOADS_SOURCE "/scripts")) {
    if (!entry.is_regular_file() || (entry.status().permissions() & fs::perms::owner_exec) == fs::perms::none) continue;
    const Outcome help = runCommand(entry.path().string(), "--help");
    EXPECT_EQ(help.exit_code, 0) << entry.path() << '\n' << help.err;
    EXPECT_GT(help.out.size(), 60u) << entry.path();
    EXPECT_EQ(help.out.find("installing:"), std::string::npos) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 14);
}

TEST(Scripts, TestRefusesARoomThatDoesNotExist) {
  const Outcome outcome = runCommand(HAMMER_LOADS_SOURCE "/scripts/test", "no_such_room");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("no_such_room: must be a folder of"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace hammer_loads::test
