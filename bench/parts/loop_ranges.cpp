#include "bench/parts/loop_ranges.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/parts/whole_number.hpp"

namespace mpm {
namespace {

std::optional<LoopRange> range_in(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos)
    return std::nullopt;
  const auto first = whole_number_in(text.substr(0, colon)), end = whole_number_in(text.substr(colon + 1));
  return first && end ? std::optional(LoopRange{*first, *end}) : std::nullopt;
}

/// Appends a range to others. If it touches the last one, extends that one instead.
void append(LoopRanges& ranges, const LoopRange& next) {
  if (!ranges.empty() && ranges.back().end == next.first)
    ranges.back().end = next.end;
  else
    ranges.push_back(next);
}

}  // namespace

LoopRanges parse_loop_ranges(std::string_view text, std::int64_t count) {
  LoopRanges ranges;
  std::int64_t least = 0;
  for (std::string_view rest = text, word; rest.data() != nullptr;) {
    const std::size_t comma = rest.find(',');
    word = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    const std::optional<LoopRange> range = range_in(word);
    if (!range || range->first < least || range->end <= range->first || range->end > count)
      throw InputError(
          "--range", fmt::format("'{}'", text),
          fmt::format("A:B for the loops A to B - 1, or several in ascending order, A:B,C:D, with "
                      "numbers from 0 to {}, the number of loops of the campaign",
                      count));
    least = range->end;
    append(ranges, *range);
  }
  return ranges;
}

std::string to_string(const LoopRanges& ranges) {
  std::string text;
  for (const LoopRange& range : ranges)
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", range.first, range.end);
  return text;
}

LoopRanges ranges_of(const std::vector<std::int64_t>& indices) {
  LoopRanges ranges;
  for (const std::int64_t index : indices)
    append(ranges, {index, index + 1});
  return ranges;
}

std::int64_t size_of(const LoopRanges& ranges) {
  std::int64_t size = 0;
  for (const LoopRange& range : ranges)
    size += range.end - range.first;
  return size;
}

LoopRanges piece_of(const LoopRanges& ranges, std::int64_t number, std::int64_t of) {
  const std::int64_t size = size_of(ranges);
  const auto bound = [&](std::int64_t k) {  // size * k / of, without a product that may overflow
    return size / of * k + size % of * k / of;
  };
  std::int64_t skip = bound(number - 1), left = bound(number) - skip;
  LoopRanges piece;
  for (const LoopRange& range : ranges) {
    const std::int64_t first = range.first + std::min(skip, range.end - range.first);
    const std::int64_t end = first + std::min(left, range.end - first);
    skip -= first - range.first;
    left -= end - first;
    if (end > first)
      piece.push_back({first, end});
  }
  return piece;
}

std::vector<std::int64_t> indices_in(const LoopRanges& ranges) {
  std::vector<std::int64_t> indices;
  for (const LoopRange& range : ranges)
    for (std::int64_t index = range.first; index < range.end; ++index)
      indices.push_back(index);
  return indices;
}

}  // namespace mpm
