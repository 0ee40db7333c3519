#include "results/files/sha256.hpp"

#include <array>
#include <stdexcept>

#include <fmt/format.h>
#include <openssl/evp.h>

namespace mpm {

namespace {

EVP_MD_CTX* context(const std::shared_ptr<void>& state) {
  return static_cast<EVP_MD_CTX*>(state.get());
}

void require(int result) {
  if (result != 1)
    throw std::runtime_error("OpenSSL computes no SHA-256");
}

}  // namespace

std::string sha256(std::span<const std::byte> content) {
  Sha256 hash;
  hash.add(content);
  return hash.digits();
}

Sha256::Sha256() : state_(EVP_MD_CTX_new(), [](void* p) { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(p)); }) {
  require(state_ && EVP_DigestInit_ex(context(state_), EVP_sha256(), nullptr) == 1 ? 1 : 0);
}

void Sha256::add(std::span<const std::byte> piece) {
  require(EVP_DigestUpdate(context(state_), piece.data(), piece.size()));
}

std::string Sha256::digits() {
  constexpr std::size_t kHashBytes = 32;
  std::array<unsigned char, kHashBytes> hash{};
  unsigned length = 0;
  require(EVP_DigestFinal_ex(context(state_), hash.data(), &length));
  std::string digits;
  for (const unsigned char byte : hash)
    digits += fmt::format("{:02x}", byte);
  return digits;
}

}  // namespace mpm
