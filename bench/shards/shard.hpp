#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "bench/shards/shard_identity.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {

/// Version of the format of a shard; a reader reads only its own version.
inline constexpr std::int32_t kShardVersion = 3;

/// Collects the bytes of a shard: pieces of finished work of an unfinished run, each under its key
/// (docs/running.md). The format: "mpmbench shard" and a line end, version, identity, seconds, key and bytes
/// of each entry to the end, all as results/files/byte_stream writes them, and the seal of
/// results/files/file_seal.
class ShardBytes {
 public:
  /// Adds an entry.
  void add(std::int64_t key, const std::string& bytes);
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// Writes what was added as a shard, all or nothing, and is empty afterwards. Throws ArchiveError if the
  /// file cannot be written; the object then keeps its entries.
  void write(const std::filesystem::path& path, const ShardIdentity& identity, double seconds);

 private:
  std::string entries_;
};

/// A shard that has just disappeared: its run, which is in progress, has packed it into another one or is
/// finished.
class ShardGone : public ArchiveError {
 public:
  explicit ShardGone(const std::filesystem::path& shard);
};

/// A whole shard whose content cannot be read although its checksum fits.
class UnreadableShard : public InputError {
 public:
  UnreadableShard(const std::filesystem::path& shard, const std::string& why);
};

/// Where in a shard the bytes of an entry are.
struct ShardPlace {
  std::int64_t key;
  std::uint64_t begin;
  std::uint64_t size;
};

/// What is in a shard.
struct ShardContent {
  double seconds = 0.0;  ///< wall-clock time of its work
  std::vector<ShardPlace> places;
  std::string file;  ///< all bytes of the shard

  std::string_view bytes(const ShardPlace& place) const {
    return std::string_view(file).substr(place.begin, place.size);
  }
};

/// The content of a shard; none when it is cut off or damaged (its checksum does not fit) or cannot be read.
/// Throws InputError for a whole file that is no shard, OtherRun for another format version or identity,
/// UnreadableShard and ShardGone.
std::optional<ShardContent> read_shard(const std::filesystem::path& path, const ShardIdentity& identity);

}  // namespace mpm
