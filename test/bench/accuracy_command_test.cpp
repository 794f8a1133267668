// Tests of the file that `accuracy` writes.
#include <gtest/gtest.h>

#include "support/command.h"

namespace hammer_loads::accuracy {
namespace {

TEST(Command, ReplacesNoFileThatItDidNotWrite) {
  const test::TemporaryFile written("{\"sessions\": []}\n", ".json"), notes("notes\n", ".json");
  const auto expectRefused = [](const std::string& arguments, const std::string& reason) {
    const test::Outcome run = test::runCommand(HAMMER_LOADS_ACCURACY, "--json " + arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find(reason), std::string::npos) << run.err;
    EXPECT_EQ(test::linesOf(run.err).size(), 1U) << run.err;
    EXPECT_EQ(run.out, "") << "before it computes";
  };
  expectRefused(written.path(), "exists already");
  expectRefused(notes.path() + " --force", "it holds no figures of this command");
  expectRefused(testing::TempDir() + " --force", "is a directory");
  EXPECT_EQ(test::contentOf(written.path()), "{\"sessions\": []}\n");
  EXPECT_EQ(test::contentOf(notes.path()), "notes\n");
}

}  // namespace
}  // namespace hammer_loads::accuracy
