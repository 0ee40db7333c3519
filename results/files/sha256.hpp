#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace mpm {

/// SHA-256 in hexadecimal digits, as sha256sum prints it.
std::string sha256(std::span<const std::byte> content);

/// The same of content that comes piece by piece.
class Sha256 {
 public:
  Sha256();
  void add(std::span<const std::byte> piece);
  /// Of all pieces; once, at the end.
  std::string digits();

 private:
  std::shared_ptr<void> state_;
};

}  // namespace mpm
