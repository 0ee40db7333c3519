#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace mpm {

/// What an attribute can hold: a text, a number, or a list of one of these.
using AttributeValue =
    std::variant<std::string, double, std::int32_t, std::int64_t, std::uint64_t, std::vector<std::int8_t>,
                 std::vector<std::int32_t>, std::vector<std::string>>;

/// Attributes in the order in which they are written.
using Attributes = std::vector<std::pair<std::string, AttributeValue>>;

/// Large variables are stored in chunks of whole rows with about this many values.
inline constexpr std::size_t kChunkValues = 16384;

}  // namespace mpm
