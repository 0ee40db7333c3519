#include "results/archive/record_subset.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "results/files/archive_error.hpp"

namespace mpm {

std::vector<ExperimentRecord*> records_along(const Hdf5Group& group, const std::string& group_name,
                                             const std::string& dimension,
                                             std::vector<ExperimentRecord>& records,
                                             const std::string& file) {
  std::vector<ExperimentRecord*> subset;
  auto record = records.begin();
  for (const std::int64_t index : group.read_list<std::int64_t>(dimension)) {
    record = std::find_if(record, records.end(), [&](const auto& r) { return r.draw.index == index; });
    if (record == records.end())
      throw ArchiveError(
          fmt::format("{}: dimension '/{}/{}': found {}; allowed: experiments of the root group in their "
                      "order, each once",
                      file, group_name, dimension, index));
    subset.push_back(&*record++);
  }
  return subset;
}

}  // namespace mpm
