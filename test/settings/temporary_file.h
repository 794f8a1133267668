/// Files that exist only as long as a test needs them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace hammer_loads::test {

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content = {}, const std::string& ending = ".yaml") {
    static int count = 0;
    path_ = testing::TempDir() + "parameters_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ending;
    std::ofstream(path_, std::ios::binary) << content;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::remove(path_.c_str()); }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace hammer_loads::test
