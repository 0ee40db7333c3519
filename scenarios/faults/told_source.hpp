#pragma once

#include <cstdint>

#include "base/enum_words.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/faults/other_fault.hpp"

namespace mpm {

/// The source of a fault as methods name it, as programs and files of verdicts write it, and as tables of
/// confusions count it: FaultSource and, for `other`, the part of the loop at fault, if the method says so.
enum class ToldSource : std::int8_t {
  none = 0,
  mpm = 1,
  ud = 2,
  mpm_ud = 3,
  other = 4,   ///< an operator, a limit, or unknown
  sensor = 5,  ///< of a CV or an MD
  valve = 6,
  data = 7,  ///< the record differs from the measurements
};

template <>
inline constexpr auto kWords<ToldSource> = word_list("none", "mpm", "ud", "mpm_ud", "other", "sensor",
                                                     "valve", "data");

constexpr FaultSource source_of(ToldSource told) {
  return told > ToldSource::other ? FaultSource::other : static_cast<FaultSource>(told);
}

/// `about` applies to the source `other` alone.
constexpr ToldSource told_source(FaultSource source, ToldSource about = ToldSource::other) {
  return source == FaultSource::other ? about : static_cast<ToldSource>(source);
}

/// The source that a method should name for this fault: sensor, valve or other.
ToldSource told_source(const OtherFault& fault);

}  // namespace mpm
