/// The file of process_bag --db has the same bytes each time, is complete or absent, and costs no other file.

#include <sys/mount.h>

#include "commands/bag_tables.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::kSession;
using test::Tables;

TEST_F(Tables, GivesEqualBytesForEqualInputWithAndWithoutABag) {
  ASSERT_EQ(tables(kSession, "one.sqlite").exit_code, 0);
  ASSERT_EQ(run(kSession + " " + path("out.bag") + " --db " + path("two.sqlite")).exit_code, 0);
  // The input has another name and directory, and the command runs in another directory.
  fs::create_directory(path("elsewhere"));
  const std::string other = copy(kSession, "elsewhere/renamed.bag");
  const test::Outcome third = test::runCommand("cd " + path("elsewhere") + " && " HAMMER_LOADS_PROCESS_BAG,
                                               "--no-bag renamed.bag --db ../three.sqlite");
  ASSERT_EQ(third.exit_code, 0) << third.err;
  EXPECT_TRUE(contentOf(path("one.sqlite")) == contentOf(path("two.sqlite")));
  EXPECT_TRUE(contentOf(path("one.sqlite")) == contentOf(path("three.sqlite")));
}

TEST_F(Tables, ForceReplacesTheirOwnKindAlone) {
  ASSERT_EQ(tables(kSession, "out.sqlite").exit_code, 0);
  const std::string bytes = contentOf(path("out.sqlite"));
  expectRefused(tables(kSession, "out.sqlite"), {path("out.sqlite"), "exists", "--force"});
  ASSERT_EQ(tables(kSession, "out.sqlite", "--force").exit_code, 0);
  EXPECT_TRUE(contentOf(path("out.sqlite")) == bytes);
  Database(path("other.sqlite"), Database::Use::kWrite, 0).run("CREATE TABLE notes(text)");
  std::ofstream(path("notes.sqlite")) << "not to be lost\n";
  fs::create_symlink(path("out.sqlite"), path("link.sqlite"));
  fs::create_directory(path("directory.sqlite"));
  const std::string in = copy(kSession, "in.bag");
  for (const char* name : {"other.sqlite", "notes.sqlite", "link.sqlite", "directory.sqlite", "in.bag"}) {
    const std::string before = fs::is_regular_file(path(name)) ? contentOf(path(name)) : "";
    expectRefused(tables(in, name, "--force"), {path(name)});
    EXPECT_TRUE(before.empty() || contentOf(path(name)) == before) << name;
  }
  EXPECT_EQ(names().size(), 6U) << "nothing left behind";
}

TEST_F(Tables, WrongUsageIsNamed) {
  EXPECT_EQ(run("--no-bag " + kSession).exit_code, 2) << "nothing to write";
  EXPECT_EQ(run(kSession + " --db " + path("out.sqlite")).exit_code, 2) << "no OUT.bag, and not said so";
  EXPECT_EQ(run(kSession + " " + path("out") + " --db " + path("out")).exit_code, 2) << "one name for two files";
  EXPECT_EQ(tables(kSession, "out.sqlite", "--pins").exit_code, 2) << "pin forces are in a bag alone";
  EXPECT_EQ(names().size(), 0U);
}

TEST_F(Tables, AFullDiskIsOneLineAndLeavesNothing) {
  ASSERT_EQ(tables(kSession, "whole.sqlite").exit_code, 0);
  const auto blocks = fs::file_size(path("whole.sqlite")) / 512;
  for (const std::uintmax_t limit : {std::uintmax_t{2}, blocks / 2, blocks - 8}) {
    const test::Outcome outcome = test::runCommand("ulimit -f " + std::to_string(limit) + "; " HAMMER_LOADS_PROCESS_BAG,
                                                   "--no-bag " + kSession + " --db " + path("out.sqlite"));
    expectRefused(outcome, {path("out.sqlite"), "cannot be written", "File too large"});
    EXPECT_EQ(names(), std::vector<std::string>{"whole.sqlite"}) << limit;
  }
  fs::create_directory(path("disk"));
  if (mount("tmpfs", path("disk").c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "only root mounts";
  const test::Outcome outcome = tables(kSession, "disk/out.sqlite");
  const bool empty = fs::is_empty(path("disk"));
  umount(path("disk").c_str());
  expectRefused(outcome, {path("disk/out.sqlite"), "cannot be written", "full"});
  EXPECT_TRUE(empty);
}

}  // namespace
}  // namespace hammer_loads
