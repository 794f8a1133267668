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

/// As roslaunch: starts a process, hears SIGINT, ends the process with SIGINT.
Outcome parentOf(const std::string& command) {
  const TemporaryFile parent(
      "import signal, subprocess, sys\n"
      "class Interrupted(Exception): pass\n"
      "def hear(*_): raise Interrupted\n"
      "signal.signal(signal.SIGINT, hear)\n"
      "child = subprocess.Popen(sys.argv[1:], start_new_session=True)\n"
      "try:\n"
      "    print('ended by itself', child.wait(timeout=120))\n"
      "except Interrupted:\n"
      "    alive = child.poll() is None\n"
      "    child.send_signal(signal.SIGINT)\n"
      "    print('interrupted', alive, child.wait(timeout=120))\n");
  return runCommand("python3", parent.path() + " " HAMMER_LOADS_SOURCE "/scripts/then_end " + command);
}

TEST(Scripts, TheGoodEndOfACommandEndsAllAndABadOneIsItsOwn) {
  EXPECT_EQ(parentOf("true").out, "interrupted True 0\n");  // it lives until it is ended
  EXPECT_EQ(parentOf("false").out, "ended by itself 1\n");
}

TEST(Scripts, TestRefusesARoomThatDoesNotExist) {
  const Outcome outcome = runCommand(HAMMER_LOADS_SOURCE "/scripts/test", "no_such_room");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("no_such_room: must be a folder of"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace hammer_loads::test
