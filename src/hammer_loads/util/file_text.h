/// Content of a file.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "hammer_loads/util/checked.h"

namespace hammer_loads {

/// Content of a file that is not empty, or the reason against it in one line. most: greatest size [byte]. kind: what
/// the file must be, for the reason.
inline Checked<std::string> fileText(const std::string& file, std::size_t most = 1'000'000'000,
                                     const std::string& kind = "a file") {
  const auto refusal = [&file](const std::string& why) { return Checked<std::string>{{}, {file + ": " + why}, {}}; };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return refusal("is a directory, must be " + kind);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text, piece(1 << 16, '\0');
  while (text.size() <= most &&
         (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())) || stream.gcount() > 0))
    text.append(piece, 0, static_cast<std::size_t>(stream.gcount()));
  if (!stream.is_open() || stream.bad()) return refusal(std::string("cannot be read: ") + std::strerror(errno));
  if (text.empty()) return refusal("cannot be read: is empty");
  if (text.size() > most) return refusal("more than " + std::to_string(most) + " bytes, must be " + kind);
  return {text, {}, {}};
}

}  // namespace hammer_loads
