/// process_bag destroys no file and leaves no partial output.
#include <fcntl.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "commands/bag_files.h"
#include "hammer_loads/commands/output_file.h"

namespace hammer_loads {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::kSession;

class OutputSafety : public test::BagFiles {};

TEST_F(OutputSafety, AnInputIsNeverTheOutputByWhateverNameOrLink) {
  const std::string in = copy(kSession, "in.bag"), bytes = contentOf(in);
  fs::create_symlink(in, path("symbolic.bag"));
  fs::create_hard_link(in, path("hard.bag"));
  fs::create_directory(path("d"));
  fs::create_directory_symlink(directory_, path("d/up"));
  for (const char* force : {"", " --force"}) {
    for (const char* name : {"in.bag", "symbolic.bag", "hard.bag", "d/up/in.bag", "d/../in.bag"})
      expectRefused(run(in + " " + path(name) + force), {path(name), "input"});
    // The input is one of several and is itself given as a link.
    const std::string second = path("second.bag");
    if (!fs::exists(second)) fs::copy_file(std::string(HAMMER_LOADS_TEST_DATA) + "/mo100_1khz.bag", second);
    expectRefused(run(second + " " + path("symbolic.bag") + " " + in + force), {in, "input"});
  }
  EXPECT_TRUE(contentOf(in) == bytes);
  EXPECT_EQ(names(), (std::vector<std::string>{"d", "hard.bag", "in.bag", "second.bag", "symbolic.bag"}));
}

TEST_F(OutputSafety, AnExistingFileStaysWithoutForce) {
  ASSERT_EQ(run(kSession + " " + path("out.bag")).exit_code, 0);
  const std::string bytes = contentOf(path("out.bag"));
  std::ofstream(path("out.bag"), std::ios::app) << "changed";
  expectRefused(run(kSession + " " + path("out.bag")), {path("out.bag"), "exists", "--force"});
  EXPECT_TRUE(contentOf(path("out.bag")) == bytes + "changed");
  expectRefused(run(kSession + " " + path("no/out.bag")), {path("no/out.bag"), "No such file or directory"});
  fs::create_symlink(path("nowhere"), path("dangling.bag"));
  expectRefused(run(kSession + " " + path("dangling.bag") + " --force"), {"symbolic link"});
  EXPECT_FALSE(fs::exists(path("nowhere")));
}

/// Recordings, logs of a node (outputs and inputs, the latter possibly under the node's own name) and notes are kept.
TEST_F(OutputSafety, ForceReplacesNothingElse) {
  const auto write = [&](const std::string& name, const std::string& crank_topic, bool run_info) {
    rosbag::Bag bag(path(name), rosbag::bagmode::Write);
    if (run_info) bag.write("/hammer_loads/run_info", ros::Time(1.0), RunInfo());
    bag.write(crank_topic, ros::Time(1.0), sensor_msgs::JointState());
  };
  write("recording.bag", "/hammer/crank", false);
  write("log.bag", "/machine/crank", true);
  write("own_name.bag", "/hammer_loads/crank", true);
  write("mechanism.bag", "/hammer_loads/mechanism", false);
  { rosbag::Bag(path("nothing.bag"), rosbag::bagmode::Write); }
  std::ofstream(path("notes.bag")) << "not to be lost\n";
  std::ofstream(path("empty.bag")).flush();
  fs::copy_file(kSession, path("other.bag"));
  for (const std::string& name : names()) {
    const std::string bytes = contentOf(path(name));
    expectRefused(run(kSession + " " + path(name) + " --force"), {path(name), "--force does not replace it"});
    EXPECT_TRUE(contentOf(path(name)) == bytes) << name;
  }
  EXPECT_EQ(names().size(), 8U) << "nothing left behind";
  // The output of one command may be the input of the next.
  ASSERT_EQ(run(kSession + " " + path("out.bag")).exit_code, 0);
  expectRefused(run(kSession + " " + path("out.bag") + " --force --imu-topic /hammer_loads/mechanism"), {"an input"});
}

TEST_F(OutputSafety, NeverReplacesAFileThatIsNotRegular) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  fs::create_symlink(path("fifo"), path("to_fifo"));
  fs::create_directory(path("directory"));
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path("socket").copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0) << path("socket");
  close(descriptor);
  for (const char* force : {"", " --force"}) {
    expectRefused(run(kSession + " " + path("fifo") + force), {"is a FIFO"});
    expectRefused(run(kSession + " " + path("to_fifo") + force), {"is a symbolic link"});
    expectRefused(run(kSession + " " + path("directory") + force), {"is a directory"});
    expectRefused(run(kSession + " " + path("socket") + force), {"is a socket"});
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"directory", "fifo", "socket", "to_fifo"}));
  EXPECT_TRUE(fs::is_fifo(path("fifo")));
  EXPECT_TRUE(fs::is_socket(path("socket")));
}

/// Uses a null device of its own where one can be created. A test never touches the system's device.
TEST_F(OutputSafety, ADeviceIsNeverReplaced) {
  const std::string device = path("null");
  if (mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) GTEST_SKIP() << "only root makes devices";
  expectRefused(run(kSession + " " + device + " --force"), {"is a device"});
  EXPECT_TRUE(fs::is_character_file(device));
  EXPECT_EQ(names(), (std::vector<std::string>{"null"}));
}

TEST_F(OutputSafety, AFullQuotaIsOneLineAndLeavesNothing) {
  // The limits end the file at the bag's header, in a chunk and in the index. The shell counts blocks of 512 bytes, so
  // the last limit is one byte or more too small.
  ASSERT_EQ(run(kSession + " " + path("whole.bag")).exit_code, 0);
  const auto blocks = fs::file_size(path("whole.bag")) / 512;
  for (const std::uintmax_t limit : {std::uintmax_t{2}, blocks / 2, blocks}) {
    const test::Outcome outcome = test::runCommand("ulimit -f " + std::to_string(limit) + "; " HAMMER_LOADS_PROCESS_BAG,
                                                   kSession + " " + path("out.bag"));
    expectRefused(outcome, {path("out.bag"), "cannot be written", "File too large"});
    EXPECT_EQ(names(), (std::vector<std::string>{"whole.bag"})) << limit;
  }
}

TEST_F(OutputSafety, AFullDiskIsOneLineAndLeavesNothing) {
  fs::create_directory(path("disk"));
  if (mount("tmpfs", path("disk").c_str(), "tmpfs", 0, "size=512k") != 0) GTEST_SKIP() << "only root mounts";
  const test::Outcome outcome = run(kSession + " " + path("disk/out.bag"));
  const bool empty = fs::is_empty(path("disk"));
  umount(path("disk").c_str());
  expectRefused(outcome, {path("disk/out.bag"), "cannot be written", "No space left on device"});
  EXPECT_TRUE(empty);
}

/// The previous content of the file is still there.
TEST_F(OutputSafety, AFailureWithForceKeepsTheOldOutput) {
  ASSERT_EQ(run(kSession + " " + path("out.bag")).exit_code, 0);
  const std::string bytes = contentOf(path("out.bag"));
  const test::Outcome outcome =
      test::runCommand("ulimit -f 100; " HAMMER_LOADS_PROCESS_BAG, kSession + " " + path("out.bag") + " --force");
  expectRefused(outcome, {"File too large"});
  EXPECT_TRUE(contentOf(path("out.bag")) == bytes);
  EXPECT_EQ(names().size(), 1U);
}

/// The file appears between the check and the end of the work.
TEST_F(OutputSafety, AFileThatAppearsMeanwhileIsNotReplaced) {
  const auto publish = [&](bool appears) {
    Checked<OutputFile> file = OutputFile::make({path("out"), {}, true, [](const std::string&) { return ""; }});
    std::ofstream(file.value->path()) << "new";
    if (appears) std::ofstream(path("out")) << "other";
    return file.value->publish();
  };
  EXPECT_NE(publish(true).find(path("out") + ": has appeared meanwhile"), std::string::npos);
  EXPECT_EQ(contentOf(path("out")), "other");
  EXPECT_EQ(names(), (std::vector<std::string>{"out"}));
  EXPECT_EQ(publish(false), "");  // the file may be replaced
  EXPECT_EQ(contentOf(path("out")), "new");
  EXPECT_EQ(names(), (std::vector<std::string>{"out"}));
}

/// process_bag interrupted by a signal while it writes.
class Interrupted : public OutputSafety, public testing::WithParamInterface<int> {};

TEST_P(Interrupted, EndsWith130AndLeavesNothing) {
  // The bag repeats the session, so that the run lasts long enough to be interrupted.
  {
    rosbag::Bag bag(path("long.bag"), rosbag::bagmode::Write);
    test::forEachOfSession([&](const rosbag::MessageInstance& item) {
      for (int i = 0; i < 8; ++i) bag.write(item.getTopic(), item.getTime() + ros::Duration(100.0 * i), item);
    });
  }
  const pid_t child = fork();
  if (child == 0) {
    signal(GetParam(), SIG_DFL);
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDERR_FILENO);
    execl(HAMMER_LOADS_PROCESS_BAG, "process_bag", path("long.bag").c_str(), path("out.bag").c_str(), nullptr);
    _exit(127);
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (names().size() < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  ASSERT_EQ(names().size(), 2U) << "the unfinished file";
  kill(child, GetParam());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(names(), (std::vector<std::string>{"long.bag"}));
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupted, testing::Values(SIGINT, SIGTERM, SIGHUP));

}  // namespace
}  // namespace hammer_loads
