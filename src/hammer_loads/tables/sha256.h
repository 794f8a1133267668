/// SHA-256 of texts and files, in hexadecimal.
#pragma once

#include <string>
#include <vector>

namespace hammer_loads {

/// Digest of texts, each with its length, so that different lists have different digests.
std::string sha256Of(const std::vector<std::string>& texts);

/// Digest of the bytes of the files, one behind the other. Throws std::runtime_error where one cannot be read.
std::string sha256OfFiles(const std::vector<std::string>& files);

}  // namespace hammer_loads
