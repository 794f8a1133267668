/// The revision that a log carries is that of the source as it was built.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace hammer_loads::test {
namespace {

namespace fs = std::filesystem;

/// A source of its own, in a directory that git knows or not.
class RevisionTest : public ::testing::Test {
 protected:
  RevisionTest() {
    std::string pattern = (fs::temp_directory_path() / "hammer_loads_revision_XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    source_ = root_ / "source";
    fs::create_directory(source_);
    fs::copy(HAMMER_LOADS_SOURCE "/cmake", source_ / "cmake");
    for (const char* name : {"package.xml", ".gitattributes"})
      fs::copy_file(fs::path(HAMMER_LOADS_SOURCE) / name, source_ / name);
  }
  ~RevisionTest() override { fs::remove_all(root_); }

  std::string run(const std::string& command, const fs::path& where) {
    const fs::path out = root_ / "out";
    // No repository around the temporary directory, no settings of the user.
    const std::string line = "cd '" + where.string() + "' && env -u GIT_DIR GIT_CONFIG_GLOBAL=/dev/null " +
                             "GIT_CEILING_DIRECTORIES='" + root_.parent_path().string() + "' " + command + " > '" +
                             out.string() + "' 2>&1";
    const int status = std::system(line.c_str());
    std::ostringstream text;
    text << std::ifstream(out).rdbuf();
    EXPECT_EQ(status, 0) << command << '\n' << text.str();
    std::string answer = text.str();
    if (!answer.empty() && answer.back() == '\n') answer.pop_back();
    return answer;
  }
  std::string git(const std::string& arguments) {
    return run("git -c user.name=a -c user.email=a@b.invalid " + arguments, source_);
  }
  /// As at every build.
  std::string revision(const fs::path& source) {
    run("cmake -DSOURCE='" + source.string() + "' -DHEADER='" + header().string() + "' -P '" + source.string() +
            "/cmake/revision.cmake'",
        root_);
    std::string define, name, value;
    std::ifstream(header()) >> define >> name >> value;
    EXPECT_EQ(name, "HAMMER_LOADS_REVISION");
    return value.substr(1, value.size() - 2);
  }
  fs::path header() const { return root_ / "source_revision.h"; }

  fs::path root_, source_;
};

TEST_F(RevisionTest, FollowsTheCheckoutAtEveryBuildAndKeepsTheFileIfNothingChanged) {
  git("init -q");
  git("add .");
  git("commit -q -m one");
  const std::string first = git("rev-parse --short=12 HEAD");
  EXPECT_EQ(revision(source_), first);
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(header(), old);
  EXPECT_EQ(revision(source_), first);
  EXPECT_EQ(fs::last_write_time(header()), old) << "nothing is compiled again";
  std::ofstream(source_ / "package.xml", std::ios::app) << "<!-- changed -->\n";
  EXPECT_EQ(revision(source_), first + "-dirty");
  git("commit -q -a -m two");
  const std::string second = git("rev-parse --short=12 HEAD");
  EXPECT_NE(second, first);
  EXPECT_EQ(revision(source_), second);
  git("tag -a v1 -m v1");
  EXPECT_EQ(revision(source_), "v1");
}

TEST_F(RevisionTest, IsUnknownOutsideGitAndInsideAnotherRepository) {
  EXPECT_EQ(revision(source_), "unknown");
  run("git init -q", root_);
  run("git -c user.name=a -c user.email=a@b.invalid commit -q --allow-empty -m other", root_);
  EXPECT_EQ(revision(source_), "unknown");
}

TEST_F(RevisionTest, ComesWithAnArchive) {
  git("init -q");
  git("add .");
  git("commit -q -m one");
  git("archive --prefix=copy/ -o ../copy.tar HEAD");
  run("tar xf copy.tar", root_);
  const std::string revision_of_copy = revision(root_ / "copy");
  EXPECT_GE(revision_of_copy.size(), 7u);
  EXPECT_EQ(git("rev-parse HEAD").rfind(revision_of_copy, 0), 0u) << revision_of_copy;
}

}  // namespace
}  // namespace hammer_loads::test
