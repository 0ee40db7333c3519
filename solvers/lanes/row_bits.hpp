#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include <Eigen/Core>

namespace mpm {

/// A set of rows: one bit a row, eight rows a byte, the first in the lowest bit; zeros up to a multiple
/// of 64.
using RowBits = std::vector<unsigned char>;

/// The empty set of `row_count` rows.
inline RowBits empty_rows(Eigen::Index row_count) {
  return RowBits(static_cast<std::size_t>((row_count + 63) / 64 * 8), 0);
}

/// Calls visit(byte, bits) with the rows that are in only one of two sets of the same length. Skips groups of
/// eight bytes in which the sets are equal.
template <class Visit>
void visit_bytes(const RowBits& a, const RowBits& b, const Visit& visit) {
  for (std::size_t first = 0; first < a.size(); first += 8) {
    std::uint64_t word_a = 0, word_b = 0;
    std::memcpy(&word_a, a.data() + first, 8);
    std::memcpy(&word_b, b.data() + first, 8);
    if (word_a == word_b)
      continue;
    for (std::size_t e = first; e < first + 8; ++e)
      visit(e, static_cast<unsigned>(a[e] ^ b[e]));
  }
}

/// Calls visit(row), in increasing order, for the rows that are in only one of the sets.
template <class Visit>
void visit_differences(const RowBits& a, const RowBits& b, const Visit& visit) {
  visit_bytes(a, b, [&](std::size_t e, unsigned bits) {
    for (; bits != 0; bits &= bits - 1)
      visit(static_cast<int>(8 * e) + std::countr_zero(bits));
  });
}

/// Counts the rows that are in only one of the sets.
inline std::size_t count_differences(const RowBits& a, const RowBits& b) {
  std::size_t count = 0;
  visit_bytes(a, b,
              [&](std::size_t, unsigned bits) { count += static_cast<std::size_t>(std::popcount(bits)); });
  return count;
}

}  // namespace mpm
