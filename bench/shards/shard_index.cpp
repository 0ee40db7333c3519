#include "bench/shards/shard_index.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr std::int32_t kNoShard = -1;
constexpr std::size_t kMostOpen = 256;  // shards at once

[[noreturn]] void refuse_changed(const std::filesystem::path& shard) {
  if (std::error_code no_status; !std::filesystem::exists(shard, no_status))
    throw ShardGone(shard);
  throw ArchiveError(fmt::format("{}: cut off or damaged since it was written", shard.string()));
}

}  // namespace

/// Keeps shards open while outcomes are read one after the other: neighbours lie in the same few shards.
class ShardIndex::Reader {
 public:
  explicit Reader(const ShardSet& set) : set_(set) {}

  ExperimentOutcome read(const Place& place) {
    bytes_.resize(place.size);
    std::ifstream& file = opened(place.shard);
    file.seekg(static_cast<std::streamoff>(place.begin));
    file.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    if (!file)
      refuse_changed(path(place));
    return set_.format().from_bytes(bytes_);
  }

  const std::filesystem::path& path(const Place& place) const {
    return set_.shards()[static_cast<std::size_t>(place.shard)];
  }

 private:
  std::ifstream& opened(std::int32_t shard) {
    if (const auto found = files_.find(shard); found != files_.end())
      return found->second;
    if (files_.size() == kMostOpen)
      files_.clear();
    std::ifstream file(set_.shards()[static_cast<std::size_t>(shard)], std::ios::binary);
    return files_.emplace(shard, std::move(file)).first->second;
  }

  const ShardSet& set_;
  std::map<std::int32_t, std::ifstream> files_;
  std::string bytes_;
};

ShardIndex::ShardIndex(const ShardSet& set) : set_(set), places_(set.count(), {kNoShard, 0, 0}) {
  find_places();
  compare_repeated();
}

void ShardIndex::find_places() {
  for (std::size_t shard = 0; shard < set_.shards().size(); ++shard) {
    const std::optional<std::vector<OutcomePlace>> outcomes =
        outcome_places(set_.shards()[shard], set_.identity());
    if (!outcomes)
      refuse_changed(set_.shards()[shard]);
    for (const OutcomePlace& outcome : *outcomes) {
      const Place place{static_cast<std::int32_t>(shard), outcome.size, outcome.begin};
      Place& first = places_.at(static_cast<std::size_t>(outcome.index));
      if (first.shard == kNoShard)
        first = place;
      else
        repeated_.push_back(place);
    }
  }
}

void ShardIndex::compare_repeated() const {
  Reader reader(set_);
  for (const Place& place : repeated_) {
    const ExperimentOutcome again = reader.read(place);
    const std::int64_t index = again.record.draw.index;
    const Place& first = places_[static_cast<std::size_t>(index)];
    const std::vector<std::string> names = set_.format().differences(reader.read(first), again);
    if (!names.empty())
      throw InputError(
          fmt::format("{}: experiment {}", reader.path(place).string(), index),
          fmt::format("another {} than in {}", fmt::join(names, ", "), reader.path(first).string()),
          "the same, bit for bit: they were run by one build on processors of one kind");
  }
}

void ShardIndex::each(const Visit& visit) const {
  Reader reader(set_);
  for (const Place& place : places_)
    if (place.shard != kNoShard)
      visit(reader.read(place));
}

void ShardIndex::each_repeated(const Visit& visit) const {
  Reader reader(set_);
  for (const Place& place : repeated_)
    visit(reader.read(place));
}

}  // namespace mpm
