/// Packages of others, built from the install space.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace hammer_loads::test {
namespace {

namespace fs = std::filesystem;

const fs::path kPrefix = HAMMER_LOADS_PREFIX;
const fs::path kPackages = HAMMER_LOADS_SOURCE "/test/install";

struct Answer {
  int status{};
  std::string text;
};

Answer run(const std::string& command, const fs::path& out) {
  Answer answer;
  // The test's own environment leads to the build, not to what is installed.
  answer.status = std::system(("bash -c 'unset LD_LIBRARY_PATH; " + command + "' > " + out.string() + " 2>&1").c_str());
  std::ostringstream text;
  text << std::ifstream(out).rdbuf();
  answer.text = text.str();
  return answer;
}

/// Rows of the C++ table of doc/api.md: | `LIBRARY` | `HEADER` | for what.
std::vector<std::string> publicHeaders() {
  std::vector<std::string> headers;
  std::ifstream page(HAMMER_LOADS_SOURCE "/doc/api.md");
  const std::regex row(R"(\| `hammer_loads_\w+` \| `(hammer_loads/[\w/]+\.h)` \|.*)");
  std::smatch parts;
  for (std::string line; std::getline(page, line);)
    if (std::regex_match(line, parts, row)) headers.push_back(parts[1]);
  return headers;
}

void addWithIncludes(const std::string& header, std::set<std::string>& all) {
  std::ifstream file(HAMMER_LOADS_SOURCE "/src/" + header);
  if (!file || !all.insert(header).second) return;
  for (std::string line; std::getline(file, line);) {
    const std::string begin = "#include \"hammer_loads/";
    if (line.rfind(begin, 0) == 0) addWithIncludes(line.substr(10, line.find('"', 10) - 10), all);
  }
}

class DownstreamTest : public ::testing::Test {
 protected:
  /// Only into a directory of the build: what a user installed is not touched.
  static void SetUpTestSuite() {
    if (kPrefix.string().rfind(HAMMER_LOADS_BUILD, 0) != 0) return;
    fs::remove_all(kPrefix);
    const Answer installed = run("cmake --install " HAMMER_LOADS_BUILD, fs::path(HAMMER_LOADS_BUILD) / "install.log");
    ASSERT_EQ(installed.status, 0) << installed.text;
  }
  /// Below the package roslaunch would find each launch file twice.
  static void TearDownTestSuite() {
    if (kPrefix.string().rfind(HAMMER_LOADS_BUILD, 0) == 0) fs::remove_all(kPrefix);
  }

  void SetUp() override {
    if (kPrefix.string().rfind(HAMMER_LOADS_BUILD, 0) != 0) GTEST_SKIP() << kPrefix << " is not of this build";
    std::string pattern = (fs::temp_directory_path() / "hammer_loads_install_XXXXXX").string();
    build_ = mkdtemp(pattern.data());
  }
  ~DownstreamTest() override {
    if (!build_.empty()) fs::remove_all(build_);
  }

  /// In an environment that knows the install space alone.
  Answer inInstallSpace(const std::string& command) {
    return run(
        "unset ROS_PACKAGE_PATH CMAKE_PREFIX_PATH PYTHONPATH LD_LIBRARY_PATH; [ ! -e /opt/ros/noetic/setup.bash ] || "
        ". /opt/ros/noetic/setup.bash; . " +
            (kPrefix / "setup.bash").string() + "; export ROS_LOG_DIR=" + build_.string() + "; " + command,
        build_ / "log.txt");
  }
  void build(const std::string& package, const std::string& after = "true") {
    const Answer built = inInstallSpace("cmake -DCMAKE_UNITY_BUILD=ON -G \"" HAMMER_LOADS_GENERATOR "\" -S " +
                                        (kPackages / package).string() + " -B " + build_.string() +
                                        " && cmake --build " + build_.string() + " && " + after);
    ASSERT_EQ(built.status, 0) << built.text;
  }

  fs::path build_;
};

TEST_F(DownstreamTest, LinksTheLibrariesWithoutRosByTheirOwnNames) {
  build("use_library");
  const Answer own = run((build_ / "devel/lib/use_library/use_pipeline").string(),
                         build_ / "own.txt");  // no setup.bash: they are found
  EXPECT_EQ(own.status, 0) << own.text;
  const Answer ours =
      run((kPrefix / "lib/hammer_loads/turn_table --summary --level rocker").string(), build_ / "a.txt");
  EXPECT_EQ(ours.status, 0);
  EXPECT_EQ(own.text, ours.text);
  EXPECT_EQ(run((build_ / "devel/lib/use_library/use_core").string(), build_ / "core.txt").status, 0);
  const Answer libraries = run("ldd " + (build_ / "devel/lib/use_library/use_core").string(), build_ / "ldd.txt");
  EXPECT_NE(libraries.text.find((kPrefix / "lib/libhammer_loads_core.so").string()), std::string::npos)
      << libraries.text;
  for (const char* other : {"libros", "libboost", "librosbag", "hammer_loads_ros", "libkdl"})
    EXPECT_EQ(libraries.text.find(other), std::string::npos) << libraries.text;
}

TEST_F(DownstreamTest, LinksAndIncludesThePublicInterface) {
  build("use_api");
  const std::vector<std::string> headers = publicHeaders();
  EXPECT_GT(headers.size(), 10u);
  for (const std::string& header : headers) {
    const std::string name = fs::path(header).stem().string();
    const Answer own = run((build_ / "devel/lib/use_api/use_").string() + name, build_ / "own.txt");
    EXPECT_EQ(own.status, 0) << name << ": " << own.text;
  }
}

TEST_F(DownstreamTest, RunsWhatIsPython) {
  const Answer report = inInstallSpace("rosrun hammer_loads report --version");
  EXPECT_EQ(report.status, 0) << report.text;
  EXPECT_EQ(report.text.find("hammer_loads "), 0u) << report.text;
  const Answer merge =
      inInstallSpace("$(rospack find hammer_loads)/fleet/merge.py " + (build_ / "m.sqlite").string() + " < /dev/null");
  EXPECT_EQ(merge.status, 0) << merge.text;
  EXPECT_NE(merge.text.find("0 bags"), std::string::npos) << merge.text;
}

TEST_F(DownstreamTest, UsesMessagesAndTheLibrariesWithRos) {
  build("use_messages");
  const Answer own = run((build_ / "devel/lib/use_messages/use_messages").string(), build_ / "own.txt");
  EXPECT_EQ(own.status, 0) << own.text;
  EXPECT_EQ(own.text, "hammer_loads/HullLoads\nhammer_loads/RunInfo\n");
  const Answer python = inInstallSpace("python3 -c \"import hammer_loads.msg as m; print(m.HullLoads._type)\"");
  EXPECT_EQ(python.text, "hammer_loads/HullLoads\n");
}

TEST_F(DownstreamTest, TestsWithTheInstalledNode) {
  build("use_rostest", "cd " + build_.string() + " && ctest --output-on-failure");
}

TEST_F(DownstreamTest, InstalledLaunchFilesFindTheirNodelets) {
  const Answer plugins = inInstallSpace("rospack plugins --attrib=plugin nodelet");
  EXPECT_NE(plugins.text.find((kPrefix / "share/hammer_loads/nodelet_plugins.xml").string()), std::string::npos)
      << plugins.text;
  EXPECT_TRUE(fs::exists(kPrefix / "lib/libhammer_loads_nodelets.so"));
}

TEST_F(DownstreamTest, LaunchFilesListAsRequiredOnlyWhatIs) {
  for (const char* name : {"hammer_loads", "hammer_loads_nodelet", "demo", "grapple"}) {
    const Answer arguments = inInstallSpace(std::string("roslaunch hammer_loads ") + name + ".launch --ros-args");
    EXPECT_NE(arguments.text.find("Optional Arguments"), std::string::npos) << arguments.text;
    EXPECT_EQ(arguments.text.find("Required Arguments"), std::string::npos) << arguments.text;
  }
  const Answer replay = inInstallSpace("roslaunch hammer_loads replay.launch --ros-args");
  EXPECT_EQ(replay.text.rfind("Required Arguments:\n  bag: ", 0), 0u) << replay.text;
  EXPECT_NE(replay.text.find("\nOptional Arguments:"), std::string::npos) << replay.text;
  for (const char* argument :
       {"urdf_file", "boom_file", "boom_model", "boom_wrench_links", "hull_imu", "tf", "crank_joint"})
    EXPECT_NE(replay.text.find(std::string("\n  ") + argument + " (default"), std::string::npos) << argument;
}

TEST_F(DownstreamTest, LaunchArgumentsBecomeParameters) {
  const Answer given = inInstallSpace(
      "roslaunch --dump-params hammer_loads hammer_loads.launch crank_joint:=drive_joint boom_model:=rigid "
      "boom_wrench_links:=\"[arm_link, base_link]\" log_directory:=/somewhere");
  for (const char* line : {"/crank_joint: drive_joint", "/boom: rigid", "/boom_wrench_links:\n- arm_link\n- base_link",
                           "/log_directory: /somewhere"})
    EXPECT_NE(given.text.find(std::string("/hammer_loads") + line), std::string::npos) << line << '\n' << given.text;
  const Answer shipped = inInstallSpace("roslaunch --dump-params hammer_loads hammer_loads.launch");
  for (const char* line : {"/crank_joint: hammer_crank_joint", "/boom: auto", "/boom_wrench_links: []"})
    EXPECT_NE(shipped.text.find(std::string("/hammer_loads") + line), std::string::npos) << line;
  EXPECT_EQ(shipped.text.find("crank_length_m"), std::string::npos);  // the node says that it takes the MO-100
  const fs::path calibration = build_ / "calibration.yaml";
  std::ofstream(calibration) << "crank_zero_rad: 0.125\ndrive_inertia_kg_m2: 0.375\n";
  for (const char* launch : {"hammer_loads", "hammer_loads_nodelet", "replay", "demo"}) {
    const Answer merged = inInstallSpace("roslaunch --dump-params hammer_loads " + std::string(launch) +
                                         ".launch calibration_file:=" + calibration.string() + " hammer_file:=" +
                                         (kPrefix / "share/hammer_loads/config/hammer_mo100.yaml").string() +
                                         (std::string(launch) == "replay" ? " bag:=some.bag" : ""));
    for (const char* line : {"/crank_zero_rad: 0.125", "/drive_inertia_kg_m2: 0.375", "/crank_length_m: 0.048"})
      EXPECT_NE(merged.text.find(std::string("/hammer_loads") + line), std::string::npos)
          << launch << line << merged.text;
  }
  // In a namespace, and with frames of its own, rviz shows the machine of that namespace.
  std::ostringstream launch_text;
  launch_text << std::ifstream(kPrefix / "share/hammer_loads/launch/hammer_loads.launch").rdbuf();
  EXPECT_NE(launch_text.str().find("-f '$(arg fixed_frame)'"), std::string::npos);
  std::ostringstream picture;
  picture << std::ifstream(kPrefix / "share/hammer_loads/rviz/hammer_loads.rviz").rdbuf();
  EXPECT_NE(picture.str().find("Topic: hammer_loads/hull_wrench"), std::string::npos);
  EXPECT_EQ(picture.str().find("Topic: /"), std::string::npos);
  const Answer command =
      inInstallSpace("roslaunch --args /hammer_loads hammer_loads hammer_loads.launch hull_imu:=/imu");
  EXPECT_NE(command.text.find("hull_imu:=/imu"), std::string::npos) << command.text;
}

TEST_F(DownstreamTest, InstallsThePublicHeadersAndWhatTheyIncludeAlone) {
  std::set<std::string> expected;
  for (const std::string& header : publicHeaders()) addWithIncludes(header, expected);
  std::set<std::string> installed;
  for (const auto& entry : fs::recursive_directory_iterator(kPrefix / "include")) {
    const std::string header = fs::relative(entry.path(), kPrefix / "include").string();
    // Generated headers, of messages and of dynamic_reconfigure, have no directory below hammer_loads.
    if (entry.is_regular_file() && fs::path(header).parent_path() != "hammer_loads") installed.insert(header);
  }
  EXPECT_EQ(installed, expected);
}

}  // namespace
}  // namespace hammer_loads::test
