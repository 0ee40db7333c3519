#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/records/time_stamps.hpp"

namespace mpm {

/// The rows that have stamps, from the earliest to the latest.
struct RowsInTime {
  std::vector<std::size_t> rows;
  bool turned = false;      ///< the newest row came first
  std::size_t without = 0;  ///< rows without a stamp
  std::size_t doubles = 0;  ///< rows with the stamp of the row before them
};

/// Sorts rows by their stamps. Errors: InputError with the line if stamps go back, or if local times lack an
/// hour at night or have it twice, as when a clock is changed.
RowsInTime rows_in_time(const StampSource& source, const TimeStamps& stamps);

}  // namespace mpm
