/// What HAMMER_LOADS_ROS=OFF installs, and a project that uses it. The libraries are this build's own, which link
/// nothing of ROS: .ci/nightly compiles them without it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/command.h"

namespace hammer_loads::test {
namespace {

namespace fs = std::filesystem;

class WithoutRos : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::string pattern = (fs::temp_directory_path() / "hammer_loads_without_ros_XXXXXX").string();
    root_ = mkdtemp(pattern.data());
    // A package of ROS that is looked for is not to be found, whatever is on this machine.
    configured_ = bash(
        "cmake -G \"" HAMMER_LOADS_GENERATOR "\" -S " HAMMER_LOADS_SOURCE " -B " + build() +
        " -DCMAKE_INSTALL_PREFIX=" + prefix() +
        " -DHAMMER_LOADS_ROS=OFF -DBUILD_TESTING=OFF -DCMAKE_BUILD_WITH_INSTALL_RPATH=ON "
        "-DCMAKE_DISABLE_FIND_PACKAGE_catkin=ON -DCMAKE_DISABLE_FIND_PACKAGE_roscpp=ON -DCMAKE_BUILD_TYPE=Release");
    if (configured_.exit_code != 0) return;
    std::string copies = "mkdir -p " + build() + "/lib " + build() + "/bin";
    for (const char* name :
         {"core", "boom", "life", "ledger", "settings", "grapple", "calibration", "pipeline", "tables"})
      copies += " && cp " HAMMER_LOADS_LIBRARIES "/libhammer_loads_" + std::string(name) + ".so " + build() + "/lib";
    for (const char* name : {"turn_table", "evaluate", "accuracy", "grapple_table", "count_cycles", "life"})
      copies += " && cp " HAMMER_LOADS_PROGRAMS "/" + std::string(name) + " " + build() + "/bin";
    const std::string module = "/lib/python3/dist-packages/hammer_loads_py";
    copies += " && { [ ! -e " HAMMER_LOADS_BUILD "/devel" + module + " ] || cp -r " HAMMER_LOADS_BUILD "/devel" +
              module + "/. " + build() + module + "; }";
    installed_ = bash(copies + " && cmake --install " + build());
  }
  static void TearDownTestSuite() { fs::remove_all(root_); }

  static Outcome bash(const std::string& command) {
    return runCommand(
        "env -u CMAKE_PREFIX_PATH -u ROS_PACKAGE_PATH -u LD_LIBRARY_PATH -u PKG_CONFIG_PATH -u PYTHONPATH",
        "bash -c '" + command + "'");
  }
  static std::string build() { return (root_ / "build").string(); }
  static std::string prefix() { return (root_ / "prefix").string(); }

  static fs::path root_;
  static Outcome configured_, installed_;
};
fs::path WithoutRos::root_;
Outcome WithoutRos::configured_, WithoutRos::installed_;

TEST_F(WithoutRos, InstallsAndIsUsedByCMakeAndByPkgConfig) {
  ASSERT_EQ(configured_.exit_code, 0) << configured_.err;
  ASSERT_EQ(installed_.exit_code, 0) << installed_.out << installed_.err;
  const std::string consumer = (root_ / "consumer").string();
  const Outcome built = bash("PKG_CONFIG_PATH=" + prefix() +
                             "/lib/pkgconfig cmake -G \"" HAMMER_LOADS_GENERATOR "\" -S " HAMMER_LOADS_SOURCE
                             "/test/install/use_without_ros -B " +
                             consumer + " -DCMAKE_PREFIX_PATH=" + prefix() + " && cmake --build " + consumer);
  ASSERT_EQ(built.exit_code, 0) << built.out << built.err;
  const Outcome right = bash(prefix() + "/bin/turn_table --summary --level rocker");
  ASSERT_EQ(right.exit_code, 0) << right.err;
  for (const char* program : {"/by_cmake", "/by_pkg_config"}) {
    const Outcome own = bash(consumer + program);
    EXPECT_EQ(own.exit_code, 0) << program << own.err;
    EXPECT_EQ(own.out, right.out) << program;
    const std::string libraries = bash("ldd " + consumer + program).out;
    EXPECT_NE(libraries.find("libhammer_loads_pipeline.so => " + prefix() + "/lib/"), std::string::npos) << libraries;
    EXPECT_EQ(libraries.find("libros"), std::string::npos) << libraries;
  }
}

/// Channel first: the words are found where ROS is.
TEST_F(WithoutRos, NothingInstalledNamesRos) {
  ASSERT_EQ(installed_.exit_code, 0) << installed_.err;
  EXPECT_NE(bash("ldd " HAMMER_LOADS_LIBRARIES "/libhammer_loads_ros.so").out.find("libroscpp"), std::string::npos);
  int linked = 0, texts = 0;
  for (const auto& entry : fs::recursive_directory_iterator(prefix())) {
    const std::string path = entry.path().string(), type = entry.path().extension();
    if (!entry.is_regular_file()) continue;
    if (type == ".so" || path.find("/bin/") != std::string::npos) {
      const std::string libraries = bash("ldd " + path).out;
      for (const char* word : {"libros", "catkin", "libkdl_parser"})
        EXPECT_EQ(libraries.find(word), std::string::npos) << path << '\n' << libraries;
      ++linked;
    }
    if (type == ".cmake" || type == ".pc") {
      const std::string text = contentOf(path);
      for (const char* word : {"roscpp", "catkin", "kdl_parser", "rosbag"})
        EXPECT_EQ(text.find(word), std::string::npos) << path;
      ++texts;
    }
  }
  EXPECT_GE(linked, 14);
  EXPECT_GE(texts, 4);
}

TEST_F(WithoutRos, PythonFindsTheModuleAndItsParameters) {
  ASSERT_EQ(installed_.exit_code, 0) << installed_.err;
  const std::string home = prefix() + "/lib/python3/dist-packages";
  if (!fs::exists(home)) GTEST_SKIP() << "built without pybind11";
  const Outcome python =
      bash("PYTHONPATH=" + home +
           " " HAMMER_LOADS_PYTHON
           " -c \"import hammer_loads_py as h; "
           "print(h.__file__, round(h.Hammer.from_yaml().pulse(level=\\\"rocker\\\")[\\\"amplitude\\\"]))\"");
  EXPECT_EQ(python.out, home + "/hammer_loads_py/__init__.py 40558\n") << python.err;
  EXPECT_TRUE(fs::exists(home + "/hammer_loads_py/__init__.pyi"));
  EXPECT_TRUE(fs::exists(home + "/hammer_loads_py/py.typed"));
}

}  // namespace
}  // namespace hammer_loads::test
