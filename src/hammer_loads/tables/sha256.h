/// SHA-256 of texts and files, in hexadecimal.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct evp_md_ctx_st;

namespace hammer_loads {

/// Takes bytes piece by piece.
class Sha256 {
 public:
  Sha256();
  Sha256& add(std::string_view bytes);
  /// Digest of all that was added, in hexadecimal digits; to be called last.
  std::string hex();

 private:
  struct Free {
    void operator()(evp_md_ctx_st* context) const;
  };
  std::unique_ptr<evp_md_ctx_st, Free> context_;
};

/// Digest of texts, each with its length, so that different lists have different digests.
std::string sha256Of(const std::vector<std::string>& texts);

/// Digest of the bytes of the files, one behind the other. Throws std::runtime_error where one cannot be read.
std::string sha256OfFiles(const std::vector<std::string>& files);

}  // namespace hammer_loads
