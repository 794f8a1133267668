#include "hammer_loads/tables/sha256.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace hammer_loads {

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
  if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 is not available");
}

Sha256& Sha256::add(std::string_view bytes) {
  EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
  return *this;
}

std::string Sha256::hex() {
  constexpr char kDigits[] = "0123456789abcdef";
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned size = 0;
  EVP_DigestFinal_ex(context_.get(), bytes.data(), &size);
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    text += kDigits[bytes[i] >> 4U];
    text += kDigits[bytes[i] & 15U];
  }
  return text;
}

std::string sha256Of(const std::vector<std::string>& texts) {
  Sha256 hash;
  for (const std::string& text : texts) hash.add(std::to_string(text.size()) + "\n").add(text);
  return hash.hex();
}

std::string sha256OfFiles(const std::vector<std::string>& files) {
  constexpr std::size_t kPiece = 1 << 20;
  std::string piece(kPiece, '\0');
  Sha256 hash;
  for (const std::string& file : files) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    ssize_t size = -1;
    while (descriptor >= 0 && (size = read(descriptor, piece.data(), piece.size())) > 0)
      hash.add({piece.data(), static_cast<std::size_t>(size)});
    const int error = errno;
    if (descriptor >= 0) close(descriptor);
    if (size != 0) throw std::runtime_error(file + ": " + std::strerror(error));
  }
  return hash.hex();
}

}  // namespace hammer_loads
