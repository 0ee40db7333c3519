#include "bench/files.hpp"

#include <fmt/format.h>
#include <unistd.h>

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

void require_output_folder(const std::filesystem::path& output, std::string_view what) {
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  if (!std::filesystem::is_directory(folder) || ::access(folder.c_str(), W_OK) != 0)
    throw ArchiveError(fmt::format("{}: no {} can be written: its folder does not exist or is not writable",
                                   output.string(), what));
  if (std::filesystem::is_directory(output))
    throw ArchiveError(fmt::format("{}: no {} can be written: it is a folder", output.string(), what));
}

}  // namespace mpm
