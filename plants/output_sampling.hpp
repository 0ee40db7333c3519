#pragma once

#include <cstdint>

#include "base/enum_words.hpp"

namespace mpm {

/// The meaning of the output of a plant at sample k.
enum class OutputSampling : std::int8_t {
  snapshot = 0,  ///< its value at k Ts
  average = 1,   ///< its mean over [(k - 1) Ts, k Ts)
};

template <>
inline constexpr auto kWords<OutputSampling> = word_list("snapshot", "average");

}  // namespace mpm
