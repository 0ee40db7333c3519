#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace mpm {

/// SHA-256 in hexadecimal digits, as sha256sum prints it.
std::string sha256(std::span<const std::byte> content);

/// The same for content that comes piece by piece.
class Sha256 {
 public:
  Sha256();
  void add(std::span<const std::byte> piece);
  /// Returns the SHA-256 of all pieces. Call it once, at the end.
  std::string digits();

 private:
  std::shared_ptr<void> state_;
};

/// The first 16 digits of the SHA-256, by which people compare contents.
std::string digest_of(std::string_view content);
/// The same for the content of a file; a file that cannot be read counts as an empty text.
std::string digest_of_file(const std::filesystem::path& path);

}  // namespace mpm
