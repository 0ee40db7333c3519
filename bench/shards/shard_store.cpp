#include "bench/shards/shard_store.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kPackedBytes = std::size_t{4} << 20;  // whoever reads a shard has all of it in memory
constexpr std::size_t kMostOpen = 256;                      // shards at once
constexpr std::int64_t kBlock = 65536;                      // keys
constexpr std::int64_t kNoKey = std::numeric_limits<std::int64_t>::max();

[[noreturn]] void refuse_changed(const std::filesystem::path& shard) {
  if (std::error_code no_status; !std::filesystem::exists(shard, no_status))
    throw ShardGone(shard);
  throw ArchiveError(fmt::format("{}: cut off or damaged since it was written", shard.string()));
}

std::uintmax_t bytes_of(const std::vector<std::filesystem::path>& files) {
  std::uintmax_t bytes = 0;
  for (const std::filesystem::path& file : files)
    bytes += std::filesystem::file_size(file);
  return bytes;
}

}  // namespace

bool KeySet::has(std::int64_t key) const {
  const auto block = blocks_.find(key / kBlock);
  return block != blocks_.end() && block->second[static_cast<std::size_t>(key % kBlock)];
}

bool KeySet::insert(std::int64_t key) {
  std::vector<bool>& block = blocks_.try_emplace(key / kBlock, kBlock).first->second;
  const bool is_new = !block[static_cast<std::size_t>(key % kBlock)];
  block[static_cast<std::size_t>(key % kBlock)] = true;
  return is_new;
}

/// Goes through the entries of shards in the order of their keys. A shard is opened when its first key is
/// reached, and stays open while others are read: neighbouring keys lie in the same few shards.
class ShardStore::Sweep {
 public:
  Sweep(const ShardStore& store, std::int64_t first, std::int64_t end)
      : store_(store), first_(first), end_(end) {
    for (std::size_t shard = 0; shard < store.shards_.size(); ++shard)
      if (store.shards_[shard].most >= first && store.shards_[shard].least < end)
        starts_.emplace_back(std::max(first, store.shards_[shard].least), shard);
    std::sort(starts_.begin(), starts_.end());
  }

  const Entry* next() {
    for (; start_ < starts_.size() && (open_.empty() || starts_[start_] < open_.begin()->first); ++start_)
      look_at(starts_[start_].second);
    if (open_.empty())
      return nullptr;
    auto earliest = open_.extract(open_.begin());
    const std::size_t shard = earliest.key().second;
    read(shard, earliest.mapped().back());
    earliest.mapped().pop_back();
    if (!earliest.mapped().empty()) {
      earliest.key() = {earliest.mapped().back().key, shard};
      open_.insert(std::move(earliest));
    }
    return &entry_;
  }

 private:
  void look_at(std::size_t shard) {
    const std::filesystem::path& path = store_.shards_[shard].path;
    std::optional<ShardContent> content = read_shard(path, store_.identity_);
    if (!content)
      refuse_changed(path);
    std::vector<ShardPlace>& places = content->places;
    std::erase_if(places, [&](const ShardPlace& place) { return place.key < first_ || place.key >= end_; });
    std::reverse(places.begin(), places.end());
    std::stable_sort(places.begin(), places.end(),
                     [](const ShardPlace& one, const ShardPlace& other) { return one.key > other.key; });
    if (!places.empty())
      open_.emplace(std::pair(places.back().key, shard), std::move(places));
  }

  void read(std::size_t shard, const ShardPlace& place) {
    if (files_.size() == kMostOpen && files_.count(shard) == 0)
      files_.clear();
    const std::filesystem::path& path = store_.shards_[shard].path;
    std::ifstream& file = files_.try_emplace(shard, path, std::ios::binary).first->second;
    entry_ = {place.key, std::string(place.size, '\0'), &path};
    file.seekg(static_cast<std::streamoff>(place.begin));
    file.read(entry_.bytes.data(), static_cast<std::streamsize>(place.size));
    if (!file)
      refuse_changed(path);
  }

  using Key = std::pair<std::int64_t, std::size_t>;  // key, and shard of the store

  const ShardStore& store_;
  std::int64_t first_, end_;
  std::vector<Key> starts_;
  std::size_t start_ = 0;
  std::map<Key, std::vector<ShardPlace>> open_;  // by the next entry, which is the last of the places
  std::map<std::size_t, std::ifstream> files_;
  Entry entry_;
};

ShardStore::ShardStore(const std::filesystem::path& folder, ShardIdentity identity, Options options)
    : identity_(std::move(identity)),
      folder_(std::make_unique<ShardFolder>(folder)),
      interval_(options.interval) {
  if (options.leftovers == Leftovers::discard)
    clear();
  const std::vector<std::filesystem::path> shards = folder_->shards();
  if (options.leftovers == Leftovers::refuse && !shards.empty())
    throw InputError(folder.string(), fmt::format("{} shards of an earlier run", shards.size()),
                     "--resume to continue it, or --discard to delete its finished work");
  try {
    take_stock(shards, options.warn);
  } catch (const InputError&) {
    if (options.leftovers != Leftovers::renew)
      throw;
    clear();
  }
}

void ShardStore::clear() {
  folder_->clear();
  shards_.clear();
  done_ = {};
  repeated_ = false;
  seconds_ = 0.0;
}

void ShardStore::take_stock(const std::vector<std::filesystem::path>& shards, const Warn& warn) {
  for (const std::filesystem::path& path : shards) {
    const std::optional<ShardContent> content = read_shard(path, identity_);
    if (!content) {
      if (warn)
        warn(fmt::format("{}: cut off or damaged, since its checksum does not match; its loops are run again",
                         path.string()));
      continue;
    }
    Shard shard{path, kNoKey, -1};
    for (const ShardPlace& place : content->places) {
      if (place.key < 0)
        throw UnreadableShard(path, fmt::format("key {}", place.key));
      repeated_ |= !done_.insert(place.key);
      shard.least = std::min(shard.least, place.key);
      shard.most = std::max(shard.most, place.key);
    }
    shards_.push_back(std::move(shard));
    seconds_ += content->seconds;
  }
}

std::vector<std::int64_t> ShardStore::missing(const std::vector<std::int64_t>& keys) const {
  std::vector<std::int64_t> missing;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(missing),
               [&](std::int64_t key) { return !has(key); });
  return missing;
}

void ShardStore::add(std::int64_t key, std::string bytes) {
  repeated_ |= !done_.insert(key);
  if (!folder_) {
    memory_.insert_or_assign(key, std::move(bytes));
    return;
  }
  hold(key, bytes);
  if (Clock::now() - written_ >= interval_ || waiting_.size() >= kMostBytes)
    flush();
}

void ShardStore::hold(std::int64_t key, const std::string& bytes) {
  next_.least = waiting_.empty() ? key : std::min(next_.least, key);
  next_.most = waiting_.empty() ? key : std::max(next_.most, key);
  waiting_.add(key, bytes);
}

ShardStore::Shard ShardStore::write(double seconds) {
  next_.path = folder_->next();
  waiting_.write(next_.path, identity_, seconds);
  return next_;
}

void ShardStore::flush() {
  if (waiting_.empty())
    return;
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - written_).count();
  shards_.push_back(write(seconds));
  seconds_ += seconds;
  written_ = now;
}

void ShardStore::compact() {
  const std::vector<std::filesystem::path> shards = folder_->shards();
  if (shards.size() > 1 + bytes_of(shards) / kPackedBytes)
    pack({});
}

void ShardStore::remove(const std::vector<std::int64_t>& keys) {
  KeySet removed;
  bool is_any = false;
  for (const std::int64_t key : keys) {
    removed.insert(key);
    is_any |= has(key);
  }
  if (is_any)
    pack(removed);
}

void ShardStore::pack(const KeySet& removed) {
  const std::vector<std::filesystem::path> before = folder_->shards();
  std::vector<Shard> after;
  double seconds = seconds_;  // the first new shard gets all of it
  std::int64_t last = -1;
  const Next next = in_order(0, kNoKey);
  while (const Entry* const entry = next()) {
    if (std::exchange(last, entry->key) == entry->key || removed.has(entry->key))
      continue;
    hold(entry->key, entry->bytes);
    if (waiting_.size() >= kPackedBytes)
      after.push_back(write(std::exchange(seconds, 0.0)));
  }
  if (!waiting_.empty())
    after.push_back(write(seconds));
  shards_ = std::move(after);
  for (const std::filesystem::path& shard : before)
    std::filesystem::remove(shard);
}

ShardStore::Next ShardStore::in_order(std::int64_t first, std::int64_t end) const {
  if (shards_.empty())
    return [this, place = memory_.lower_bound(first), end, entry = Entry()]() mutable -> const Entry* {
      if (place == memory_.end() || place->first >= end)
        return nullptr;
      entry = {place->first, place->second, nullptr};
      ++place;
      return &entry;
    };
  return [sweep = std::make_shared<Sweep>(*this, first, end)] { return sweep->next(); };
}

}  // namespace mpm
