#include "hammer_loads/commands/command_line.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

namespace hammer_loads {
void addParamsOption(CommandLine& line, std::vector<std::string>& files) {
  line.option("--params", files, "parameters over the shipped ones; may be repeated, the last one wins")
      .oneEachTime()
      .type("FILE.yaml");
}

void addLevelOption(CommandLine& line, std::optional<Level>& level) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : kRigidLevelNames) words.emplace_back(word);
  const auto take = [&level](const std::string& given) {
    for (const auto& [word, meaning] : kRigidLevelNames) {
      if (given == word) level = meaning;
    }
  };
  line.call("--level", take, "how much of the mechanism has mass; without it as in the parameters")
      .oneOf(words)
      .type("LEVEL");
}

void addUrdfOption(CommandLine& line, std::string& file) {
  line.option("--urdf", file, "robot description; with it the boom's loads as well").type("FILE.urdf");
}

int finishOutput() {
  if (std::cout.flush()) return 0;
  std::cerr << "stdout: cannot be written\n";
  return kExitFailure;
}

Checked<std::string> fileText(const std::string& file) {
  Checked<std::string> result;
  std::ostringstream text;
  errno = 0;
  std::ifstream stream(file);
  text << stream.rdbuf();  // fails for nothing at all to read as well
  const int error = errno;
  if (stream && text)
    result.value = text.str();
  else
    result.problems.push_back(file + ": cannot be read: " + (error != 0 ? std::strerror(error) : "is empty"));
  return result;
}

std::optional<Settings> loadOrReport(const std::vector<std::string>& files) {
  Checked<Settings> settings = loadFiles(configDirectory(), files);
  for (const std::string& problem : settings.problems) std::cerr << problem << '\n';
  if (!settings.value) return std::nullopt;
  for (const std::string& note : settings.notes) std::cerr << "note: " << note << '\n';
  return std::move(settings.value);
}

}  // namespace hammer_loads
