#include "bench/files/archive_input.hpp"

#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {

Campaign read_input(const std::string& archive) {
  try {
    return read_archive(archive);
  } catch (const ArchiveError& error) {
    throw BadArchive(error.what());
  }
}

const ExperimentRecord& experiment_of(const Campaign& campaign, std::int64_t index) {
  const auto count = static_cast<std::int64_t>(campaign.records.size());
  if (index < 0 || index >= count)
    throw InputError("INDEX", fmt::format("{}", index),
                     count > 0 ? fmt::format("0 to {}", count - 1) : "none, the archive has no experiments");
  return campaign.records[static_cast<std::size_t>(index)];
}

}  // namespace mpm
