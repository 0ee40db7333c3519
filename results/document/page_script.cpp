#include "results/document/page_script.hpp"

#include <array>
#include <span>
#include <string_view>

#include <openssl/sha.h>

#include "base/base64.hpp"

namespace mpm {

std::string page_script_policy() {
  const std::string_view script = kPageScript;
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(script.data()), script.size(), digest.data());
  return "'sha256-" + base64(std::as_bytes(std::span(digest))) + "'";
}

}  // namespace mpm
