/// Runs a command as its user does: arguments and stdin in, stdout, stderr and exit code out.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "settings/temporary_file.h"

namespace hammer_loads::test {

struct Outcome {
  int exit_code{};
  std::string out, err;
};

inline std::string contentOf(const std::string& path) {
  std::ostringstream text;
  std::ifstream stream(path);
  if (stream.peek() != std::ifstream::traits_type::eof()) text << stream.rdbuf();
  return text.str();
}

inline Outcome runCommand(const std::string& program, const std::string& arguments, const std::string& input = {}) {
  const TemporaryFile in(input, ".in"), out({}, ".out"), err({}, ".err");
  const std::string command = program + " " + arguments + " <" + in.path() + " >" + out.path() + " 2>" + err.path();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentOf(out.path()), contentOf(err.path())};
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

inline std::vector<double> numbersOf(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) numbers.push_back(std::stod(cell));
  return numbers;
}

}  // namespace hammer_loads::test
