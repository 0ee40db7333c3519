#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "scenarios/random/random_stream.hpp"

namespace mpm::testing {

/// Changes texts and files at random; every run tries the same changes.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : stream_(seed, 0, StreamId::measurement_noise) {}

  /// `text` with one to four changes: a byte replaced, a piece erased or doubled, a token of TOML put in, or
  /// another number in place of a digit, which leaves a TOML text behind more often than not.
  std::string mutated_toml(std::string text);

  /// `content` with one to four changes: a bit turned over, a byte replaced, a piece erased, doubled,
  /// overwritten or the rest cut off.
  std::string mutated_bytes(std::string content);

  /// Up to `longest` bytes, each as likely.
  std::string random_bytes(std::size_t longest);

  /// 0 to n - 1.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(stream_.below(n)); }

 private:
  void change_toml(std::string& text);
  void change_number(std::string& text, std::size_t place);
  void change_bytes(std::string& content);

  RandomStream stream_;
};

}  // namespace mpm::testing
