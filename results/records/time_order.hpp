#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/records/time_stamps.hpp"

namespace mpm {

/// The rows of stamps from the earliest to the latest, without those that have none.
struct RowsInTime {
  std::vector<std::size_t> rows;
  bool turned = false;      ///< the newest stood first
  std::size_t without = 0;  ///< rows without a stamp
  std::size_t doubles = 0;  ///< rows with the stamp of the row before them
};

/// Errors: InputError with the line for stamps that go back, and for local times in which an hour is missing
/// at night or comes twice, as when a clock is changed.
RowsInTime rows_in_time(const StampSource& source, const TimeStamps& stamps);

}  // namespace mpm
