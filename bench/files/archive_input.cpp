#include "bench/files/archive_input.hpp"

#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {

namespace {

/// What `read` returns, with its errors as those of an archive that a command was given.
template <class Read>
auto as_input(Read read) {
  try {
    return read();
  } catch (const ArchiveError& error) {
    throw BadArchive(error.what());
  }
}

}  // namespace

Campaign read_input(const std::string& archive) {
  return as_input([&] { return read_archive(archive); });
}

Campaign stream_input(const std::string& archive) {
  Campaign campaign = as_input([&] { return stream_archive(archive); });
  if (campaign.streamed)
    campaign.streamed = RecordRange(campaign.streamed->size(),
                                    [records = *campaign.streamed](const RecordRange::Visit& visit) {
                                      as_input([&] { records.each(visit); });
                                    });
  return campaign;
}

ExperimentRecord experiment_of(const Campaign& campaign, std::int64_t index) {
  const RecordRange records = records_of(campaign);
  const auto count = static_cast<std::int64_t>(records.size());
  if (index < 0 || index >= count)
    throw InputError("INDEX", fmt::format("{}", index),
                     count > 0 ? fmt::format("0 to {}", count - 1) : "none, the archive has no experiments");
  ExperimentRecord wanted;
  std::int64_t place = 0;
  records.each([&](const ExperimentRecord& record) {
    if (place++ == index)
      wanted = record;
  });
  return wanted;
}

}  // namespace mpm
