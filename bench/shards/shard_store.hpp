#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/execution/run_options.hpp"
#include "bench/shards/shard.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"

namespace mpm {

/// A set of whole numbers from 0 on, many of them neighbours, in little memory.
class KeySet {
 public:
  bool has(std::int64_t key) const;
  /// Returns whether the key is new.
  bool insert(std::int64_t key);

 private:
  std::map<std::int64_t, std::vector<bool>> blocks_;
};

/// The one place where finished work waits until all of it is there: bytes under keys from 0 on, in shards on
/// the disk, or in memory if there is no folder.
class ShardStore {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// How to open a folder.
  struct Options {
    Leftovers leftovers = Leftovers::resume;
    double interval = RunOptions().shard_interval;  ///< s from one shard to the next
    Warn warn = {};
  };

  struct Entry {
    std::int64_t key = 0;
    std::string bytes;
    const std::filesystem::path* shard = nullptr;  ///< the shard that it is in; null: in memory
  };
  /// The next entry at each call, valid until the next call; null after the last one.
  using Next = std::function<const Entry*()>;

  /// In memory; take_stock() adds shards that others have left.
  explicit ShardStore(ShardIdentity identity) : identity_(std::move(identity)) {}

  /// Opens the folder, which is locked as long as the store lives, and looks at the shards in it. A shard is
  /// written when the last one is `interval` old, and when 64 MiB are waiting, so that they do not fill the
  /// memory. Throws InputError if shards are there and leftovers are to be refused, and as take_stock();
  /// ArchiveError if the folder cannot be made. An error changes no shard.
  ShardStore(const std::filesystem::path& folder, ShardIdentity identity, Options options);

  /// Counts what is in these shards as done, too; they stay where they are. Skips a damaged shard with a
  /// warning. Errors: as read_shard().
  void take_stock(const std::vector<std::filesystem::path>& shards, const Warn& warn);

  /// Deletes everything.
  void clear();

  bool has(std::int64_t key) const { return done_.has(key); }
  /// The keys that the store does not have, in their order.
  std::vector<std::int64_t> missing(const std::vector<std::int64_t>& keys) const;
  /// Wall-clock time that the work in the shards took, in s.
  double seconds() const { return seconds_; }

  /// Takes finished work, and writes a shard when it is time. Throws ArchiveError when that fails.
  void add(std::int64_t key, std::string bytes);
  /// Writes all waiting results.
  void flush();

  /// Packs the shards of the folder into as few as possible, since many small files are a burden where they
  /// are kept. All entries must have been flushed. Removes damaged shards. If it is killed midway, it leaves
  /// entries in two shards. Throws ArchiveError.
  void compact();
  /// The same, but leaves out these keys. The store must not be used afterwards.
  void remove(const std::vector<std::int64_t>& keys);

  /// The entries with keys from `first` to `end` - 1 in the order of their keys; if several shards have a
  /// key, in the order of the shards. All entries must have been flushed. An entry is read when it is asked
  /// for; memory holds the places of the entries in those shards that have neighbours of this one. The store
  /// must outlive the result, which throws ArchiveError if a shard can no longer be read.
  Next in_order(std::int64_t first, std::int64_t end) const;
  /// Whether several shards have the same key.
  bool has_repeated() const { return repeated_; }

 private:
  using Clock = std::chrono::steady_clock;
  class Sweep;

  /// An intact shard.
  struct Shard {
    std::filesystem::path path;
    std::int64_t least, most;  ///< its lowest and its highest key
  };

  /// Adds an entry to the next shard.
  void hold(std::int64_t key, const std::string& bytes);
  /// Puts all but the removed entries into new shards.
  void pack(const KeySet& removed);
  /// Writes the waiting results as a shard.
  Shard write(double seconds);

  ShardIdentity identity_;
  std::unique_ptr<ShardFolder> folder_;  ///< none: in memory
  std::chrono::duration<double> interval_{0.0};
  std::vector<Shard> shards_;
  KeySet done_;
  bool repeated_ = false;
  double seconds_ = 0.0;
  ShardBytes waiting_;
  Shard next_;  ///< the shard that the waiting entries will make
  std::map<std::int64_t, std::string> memory_;
  Clock::time_point written_ = Clock::now();
};

}  // namespace mpm
