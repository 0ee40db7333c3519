#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/parts/loop_ranges.hpp"

namespace mpm {

/// A part of a campaign.
struct CampaignPart {
  LoopRanges loops;
  std::optional<PartNumber> number = {};  ///< of a piece of the whole campaign; none: any other part
};

/// The folder of a part: its shards, and `campaign.json`, which says to which campaign it belongs, so that
/// parts alone make an archive (docs/running.md).
struct PartFolder {
  std::filesystem::path path;
  Study study;             ///< as study_to_run() gave it
  RunOptions options;      ///< what decides the results; `experiments` is always there
  std::int64_t loops = 0;  ///< of the campaign
  CampaignPart part;
};

/// The folder of the parts of an archive: beside it.
std::filesystem::path parts_folder_of(const std::filesystem::path& output);

/// The name of the folder of the part that the options --range and --shard name, either of which may be
/// missing: "3-of-8", "100-150", "100-150_3-of-8".
std::string part_name(const std::string& range, const std::optional<PartNumber>& number);

/// Writes `campaign.json` of a part, whose folder must exist. Throws ArchiveError.
void write_part_description(const PartFolder& part);

/// Reads `campaign.json` of a part. Throws InputError, which names the file, if it is missing or not what
/// this program writes.
PartFolder read_part(const std::filesystem::path& folder);

/// The parts in a folder; there may be none. Throws InputError for a folder that cannot be read.
std::set<std::filesystem::path> parts_in(const std::filesystem::path& folder);

/// The folders of parts among these folders and everything in them, sorted, each once. Throws InputError for
/// a folder that does not exist or has no part.
std::vector<std::filesystem::path> find_parts(const std::vector<std::string>& folders);

}  // namespace mpm
