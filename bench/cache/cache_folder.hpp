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

/// A folder of finished work that any run may take up: files in the format of shards, each named by the
/// digest of everything that decides its content, which the file contains as well. A file that is damaged,
/// cut off or written by another program counts as none. Files appear whole, and are in memory while they are
/// used, so that any number of processes may use the folder at once. Beyond its limit, the files that have
/// not been used for longest are removed.
class CacheFolder {
 public:
  CacheFolder(std::filesystem::path path, std::uint64_t limit) : path_(std::move(path)), limit_(limit) {}

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t limit() const { return limit_; }  ///< bytes

  /// The file of this identity, which counts as used now; none: there is no whole one.
  std::optional<ShardContent> read(const ShardIdentity& identity) const;
  /// Stores `content`, and makes room for it. If that fails, nothing is kept from then on. Returns the reason
  /// the first time.
  std::optional<std::string> write(ShardBytes& content, const ShardIdentity& identity) const;

  CacheUsage usage() const;
  /// Removes the files of caches, and the folder where nothing else is in it. What was removed.
  CacheUsage clear() const;

 private:
  std::filesystem::path file_of(const ShardIdentity& identity) const;
  void make_room() const;

  std::filesystem::path path_;
  std::uint64_t limit_;
  mutable bool cannot_write_ = false;
};

/// The cache of the user: the folder MPMBENCH_CACHE, otherwise mpmbench in XDG_CACHE_HOME, otherwise in
/// ~/.cache. None: MPMBENCH_CACHE is "off", or there is no home folder. Its limit is MPMBENCH_CACHE_MB
/// megabytes. Throws InputError for a limit that is none.
std::shared_ptr<const CacheFolder> user_cache();

}  // namespace mpm
