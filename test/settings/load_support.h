/// Loads settings from the shipped files and from those that a test writes.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hammer_loads/settings/load.h"
#include "settings/temporary_file.h"

namespace hammer_loads::test {

using Lines = std::vector<std::string>;

inline Checked<Settings> loadShippedWith(const std::vector<std::string>& files) {
  return loadFiles(configDirectory(), files);
}

/// Returns the problems of the shipped files with one of this content, named FILE in the messages.
inline Lines problemsOf(const std::string& content) {
  const TemporaryFile file(content);
  const Checked<Settings> settings = loadShippedWith({file.path()});
  EXPECT_EQ(settings.value.has_value(), settings.problems.empty());
  Lines problems = settings.problems;
  for (std::string& line : problems) {
    for (std::size_t place = 0; (place = line.find(file.path())) != std::string::npos;)
      line.replace(place, file.path().size(), "FILE");
  }
  return problems;
}

}  // namespace hammer_loads::test
