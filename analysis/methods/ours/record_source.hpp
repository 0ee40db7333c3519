#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/enum_words.hpp"

namespace mpm {

/// What is the matter with a record. Exactly one is true.
enum class RecordSource : std::int8_t {
  nothing,
  mismatch,     ///< of the model alone
  disturbance,  ///< unmeasured, on a CV or an MV, alone
  both,         ///< a mismatch and a disturbance
  sensor,       ///< drifts or is biased
  valve,        ///< sticks
  data,         ///< the clock of the record: columns that are early or late, averages
  unknown,      ///< none of these
};
template <>
inline constexpr auto kWords<RecordSource> = word_list("nothing", "mismatch", "disturbance", "both", "sensor",
                                                       "valve", "data", "none_of_these");

inline constexpr std::size_t kRecordSources = kWords<RecordSource>.size();

/// All sources except `nothing`.
inline constexpr std::array kFaultSources{
    RecordSource::mismatch, RecordSource::disturbance, RecordSource::both,   RecordSource::sensor,
    RecordSource::valve,    RecordSource::data,        RecordSource::unknown};

/// A number for each source.
struct OfSources {
  std::array<double, kRecordSources> each{};

  double& operator[](RecordSource source) { return each[static_cast<std::size_t>(source)]; }
  double operator[](RecordSource source) const { return each[static_cast<std::size_t>(source)]; }
};

}  // namespace mpm
