#pragma once

#include <filesystem>
#include <vector>

namespace mpm {

/// The folder of the shards of one output. It is locked against other runs as long as the object lives.
class ShardFolder {
 public:
  /// Makes the folder unless it is there. Throws ArchiveError when it cannot be made, InputError when another
  /// run is at work in it.
  explicit ShardFolder(std::filesystem::path folder);
  /// Removes the folder when there is no shard in it.
  ~ShardFolder();
  ShardFolder(const ShardFolder&) = delete;
  ShardFolder& operator=(const ShardFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// The shards in it, whole or not, in the order in which they were written.
  std::vector<std::filesystem::path> shards() const;

  /// A name for one more shard.
  std::filesystem::path next();

  /// Removes the shards, and what a killed run has left half-written.
  void clear();

 private:
  void lock();

  std::filesystem::path path_;
  int lock_ = -1;
  int last_ = 0;  ///< number of the last shard
};

/// The shards in a folder, whole or not, in the order in which they were written; none when it is not there.
std::vector<std::filesystem::path> shards_in(const std::filesystem::path& folder);

/// The file in a folder of shards that says to which campaign they belong (bench/parts/part_folder).
inline constexpr const char* kCampaignDescription = "campaign.json";

/// The folder of the shards of an output: beside it.
std::filesystem::path shard_folder_of(const std::filesystem::path& output);

/// Removes the shards in a folder, their description, and the folder. Throws
/// InputError when a run is at work in it.
void remove_shard_folder(const std::filesystem::path& folder);

/// The same for the shards of an output, once its archive is written.
void remove_shards(const std::filesystem::path& output);

/// Whether an interrupted run of this output has left shards.
bool has_shards(const std::filesystem::path& output);

}  // namespace mpm
