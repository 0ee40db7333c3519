#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The loops `first`, ..., `end` - 1 of a campaign: its experiments in the order of their index, and behind
/// them its calibration loops.
struct LoopRange {
  std::int64_t first = 0, end = 0;

  bool operator==(const LoopRange&) const = default;
};

/// Ranges in ascending order. None is empty, and none touches the next.
using LoopRanges = std::vector<LoopRange>;

/// Reads "A:B,C:D": the loops A to B - 1, and C to D - 1. Throws InputError unless it is such a text with
/// 0 <= A < B <= C < D ... <= `count`.
LoopRanges parse_loop_ranges(std::string_view text, std::int64_t count);

/// The text from which parse_loop_ranges() reads these ranges; empty if they have no loop.
std::string to_string(const LoopRanges& ranges);

/// Converts indices in ascending order to ranges.
LoopRanges ranges_of(const std::vector<std::int64_t>& indices);

std::int64_t size_of(const LoopRanges& ranges);

/// Piece `number` (from 1 on) of `of` pieces of consecutive loops. The pieces together are all of `ranges`,
/// and their lengths differ by at most one loop. If there are fewer loops than pieces, some pieces are empty.
LoopRanges piece_of(const LoopRanges& ranges, std::int64_t number, std::int64_t of);

/// The loops in these ranges, one by one.
std::vector<std::int64_t> indices_in(const LoopRanges& ranges);

}  // namespace mpm
