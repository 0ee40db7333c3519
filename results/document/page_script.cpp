#include "results/document/page_script.hpp"

#include <array>
#include <string_view>

#include <openssl/evp.h>
#include <openssl/sha.h>

namespace mpm {

std::string page_script_policy() {
  const std::string_view script = kPageScript;
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(script.data()), script.size(), digest.data());
  std::array<unsigned char, 4 * ((SHA256_DIGEST_LENGTH + 2) / 3) + 1> text{};
  const int length = EVP_EncodeBlock(text.data(), digest.data(), static_cast<int>(digest.size()));
  return "'sha256-" +
         std::string(reinterpret_cast<const char*>(text.data()), static_cast<std::size_t>(length)) + "'";
}

}  // namespace mpm
