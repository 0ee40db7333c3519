#include "base/sha256.hpp"

#include <array>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <openssl/evp.h>

namespace mpm {
namespace {

constexpr std::size_t kShownDigits = 16;  // no accidental matches, and short enough for a message

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

std::string digest_of(std::string_view content) {
  return sha256(std::as_bytes(std::span(content))).substr(0, kShownDigits);
}

// Reads the file in pieces: an archive with its loops may not fit into memory.
std::string digest_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 16);
  Sha256 hash;
  do {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hash.add(std::as_bytes(std::span(piece).first(static_cast<std::size_t>(file.gcount()))));
  } while (file);
  return hash.digits().substr(0, kShownDigits);
}

}  // namespace mpm
