#include "results/files/sha256.hpp"

#include <array>
#include <stdexcept>

#include <fmt/format.h>
#include <openssl/evp.h>

namespace mpm {

std::string sha256(std::span<const std::byte> content) {
  constexpr std::size_t kHashBytes = 32;
  std::array<unsigned char, kHashBytes> hash{};
  unsigned length = 0;
  if (EVP_Digest(content.data(), content.size(), hash.data(), &length, EVP_sha256(), nullptr) != 1 ||
      length != hash.size())
    throw std::runtime_error("OpenSSL computes no SHA-256");
  std::string digits;
  for (const unsigned char byte : hash)
    digits += fmt::format("{:02x}", byte);
  return digits;
}

}  // namespace mpm
