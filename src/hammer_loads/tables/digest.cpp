#include "hammer_loads/tables/digest.h"

#include <openssl/evp.h>

#include <array>
#include <boost/algorithm/hex.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace hammer_loads {
namespace {

/// Digest of all bytes that fill(add) gives to add(data, size).
template <typename Fill>
std::string sha256By(const Fill& fill) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available");
  fill([&](const char* data, std::size_t size) { EVP_DigestUpdate(context.get(), data, size); });
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  EVP_DigestFinal_ex(context.get(), bytes.data(), &size);
  return boost::algorithm::hex_lower(std::string(bytes.begin(), bytes.begin() + size));
}

}  // namespace

std::string sha256Of(const std::vector<std::string>& texts) {
  return sha256By([&](const auto& add) {
    for (const std::string& text : texts) {
      const std::string with_length = std::to_string(text.size()) + "\n" + text;
      add(with_length.data(), with_length.size());
    }
  });
}

std::string sha256OfFiles(const std::vector<std::string>& files) {
  return sha256By([&](const auto& add) {
    std::string piece(1 << 20, '\0');
    for (const std::string& file : files) {
      errno = 0;
      std::ifstream stream(file, std::ios::binary);
      while (stream.read(piece.data(), static_cast<std::streamsize>(piece.size())) || stream.gcount() > 0)
        add(piece.data(), static_cast<std::size_t>(stream.gcount()));
      if (!stream.eof()) throw std::runtime_error(file + ": " + std::strerror(errno));
    }
  });
}

}  // namespace hammer_loads
