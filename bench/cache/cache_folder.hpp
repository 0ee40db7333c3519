#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bench/shards/shard.hpp"

namespace mpm {

/// How full a cache is.
struct CacheUsage {
  std::size_t files = 0;
  std::uint64_t bytes = 0;
};

/// A folder of finished work that any run may reuse. Its files have the format of shards. The name of a file
/// is the digest of everything that decides its content, and the file contains all of that as well. A file
/// that is damaged, cut off or written by another program is ignored. Files appear whole, and a reader holds
/// a file in memory while it uses it, so any number of processes may use the folder at once. If the folder
/// exceeds its limit, the least recently used files are removed.
class CacheFolder {
 public:
  CacheFolder(std::filesystem::path path, std::uint64_t limit) : path_(std::move(path)), limit_(limit) {}

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t limit() const { return limit_; }  ///< bytes

  /// Returns the file of this identity and marks it as used now; none if there is no intact one.
  std::optional<ShardContent> read(const ShardIdentity& identity) const;
  /// Stores `content` and makes room for it. If that fails, returns the reason, and stores nothing from then
  /// on.
  std::optional<std::string> write(ShardBytes& content, const ShardIdentity& identity) const;

  CacheUsage usage() const;
  /// Removes the files of the cache, and the folder if nothing else is in it. Returns what was removed.
  CacheUsage clear() const;

 private:
  std::filesystem::path file_of(const ShardIdentity& identity) const;
  void make_room() const;

  std::filesystem::path path_;
  std::uint64_t limit_;
  mutable bool cannot_write_ = false;
};

/// Returns the cache of the user: the folder MPMBENCH_CACHE, otherwise mpmbench in XDG_CACHE_HOME, otherwise
/// mpmbench in ~/.cache; null if MPMBENCH_CACHE is "off" or there is no home folder. Its limit is
/// MPMBENCH_CACHE_MB megabytes. Throws InputError for an invalid limit.
std::shared_ptr<const CacheFolder> user_cache();

}  // namespace mpm
