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

/// In ascending order, none of them empty, none beside the next.
using LoopRanges = std::vector<LoopRange>;

/// Reads "A:B,C:D": the loops A to B - 1, and C to D - 1. Throws InputError unless it is such a text with
/// 0 <= A < B <= C < D ... <= `count`.
LoopRanges parse_loop_ranges(std::string_view text, std::int64_t count);

/// The reverse: what parse_loop_ranges() reads. Empty for no loop.
std::string to_string(const LoopRanges& ranges);

/// Indices in ascending order as ranges.
LoopRanges ranges_of(const std::vector<std::int64_t>& indices);

std::int64_t size_of(const LoopRanges& ranges);

/// Number `number` (from 1 on) of `of` pieces of consecutive loops, which differ by one loop at most in their
/// length and are together all of `ranges`. Without a loop where there are fewer loops than pieces.
LoopRanges piece_of(const LoopRanges& ranges, std::int64_t number, std::int64_t of);

/// The loops in these ranges, one by one.
std::vector<std::int64_t> indices_in(const LoopRanges& ranges);

}  // namespace mpm
