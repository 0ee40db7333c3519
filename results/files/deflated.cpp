#include "results/files/deflated.hpp"

#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>

#include <zlib.h>

namespace mpm {
namespace {

/// zlib expands compressed bytes at most by this factor.
constexpr std::uint64_t kLargestRatio = 1040;

const Bytef* zlib_bytes(std::string_view text) {
  return reinterpret_cast<const Bytef*>(text.data());
}

Bytef* zlib_bytes(std::string& text, std::size_t from) {
  return reinterpret_cast<Bytef*>(text.data() + from);
}

}  // namespace

std::string deflated(std::string_view content) {
  const std::uint64_t size = content.size();
  uLongf packed = compressBound(content.size());
  std::string bytes(sizeof size + packed, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (compress2(zlib_bytes(bytes, sizeof size), &packed, zlib_bytes(content), content.size(), Z_BEST_SPEED) !=
      Z_OK)
    throw std::bad_alloc();  // the only possible error, as there is enough room
  bytes.resize(sizeof size + packed);
  return bytes;
}

std::string inflated(std::string_view bytes) {
  std::uint64_t size = 0;
  if (bytes.size() < sizeof size)
    throw std::runtime_error("packed bytes: too few");
  std::memcpy(&size, bytes.data(), sizeof size);
  bytes.remove_prefix(sizeof size);
  if (size > kLargestRatio * bytes.size())
    throw std::runtime_error("packed bytes: an impossible length");
  std::string content(size, '\0');
  uLongf found = content.size();
  if (uncompress(zlib_bytes(content, 0), &found, zlib_bytes(bytes), bytes.size()) != Z_OK || found != size)
    throw std::runtime_error("packed bytes: damaged");
  return content;
}

}  // namespace mpm
