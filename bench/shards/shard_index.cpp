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
    bytes_.resize(place.outcome.size);
    std::ifstream& file = opened(place.shard);
    file.seekg(static_cast<std::streamoff>(place.outcome.begin));
    file.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    if (!file)
      refuse_changed(path(place));
    return set_.format().from_bytes(bytes_);
  }

  const std::filesystem::path& path(const Place& place) const { return set_.shards()[place.shard]; }

 private:
  std::ifstream& opened(std::size_t shard) {
    if (const auto found = files_.find(shard); found != files_.end())
      return found->second;
    if (files_.size() == kMostOpen)
      files_.clear();
    std::ifstream file(set_.shards()[shard], std::ios::binary);
    return files_.emplace(shard, std::move(file)).first->second;
  }

  const ShardSet& set_;
  std::map<std::size_t, std::ifstream> files_;
  std::string bytes_;
};

ShardIndex::ShardIndex(const ShardSet& set) : set_(set) {
  for (std::size_t shard = 0; shard < set_.shards().size(); ++shard)
    if (const std::vector<OutcomePlace> places = places_in(shard); !places.empty())
      starts_.emplace_back(places.front().index, shard);
  std::sort(starts_.begin(), starts_.end());
  compare_repeated();
}

/// In the order of their index.
std::vector<OutcomePlace> ShardIndex::places_in(std::size_t shard) const {
  std::optional<std::vector<OutcomePlace>> places = outcome_places(set_.shards()[shard], set_.identity());
  if (!places)
    refuse_changed(set_.shards()[shard]);
  std::stable_sort(places->begin(), places->end(), [](const OutcomePlace& one, const OutcomePlace& other) {
    return one.index < other.index;
  });
  return *std::move(places);
}

/// Calls take(place, first) in the order of the index, and where several shards have an experiment in their
/// order; `first` is then the place in the first of these, null there.
template <class Take>
void ShardIndex::sweep(const Take& take) const {
  struct Open {
    std::size_t shard;
    std::vector<OutcomePlace> places;
    std::size_t next = 0;

    Key key() const { return {places[next].index, shard}; }
  };
  const auto later = [](const Open& one, const Open& other) { return one.key() > other.key(); };
  std::vector<Open> open;  // a heap, the earliest one in front
  std::optional<Place> first;
  auto start = starts_.begin();
  while (start != starts_.end() || !open.empty()) {
    if (start != starts_.end() && (open.empty() || *start < open.front().key())) {
      const std::size_t shard = start++->second;
      if (open.emplace_back(Open{shard, places_in(shard)}).places.empty())
        refuse_changed(set_.shards()[shard]);
    } else {
      std::pop_heap(open.begin(), open.end(), later);
      Open& earliest = open.back();
      const Place place{earliest.shard, earliest.places[earliest.next]};
      const bool again = first && first->outcome.index == place.outcome.index;
      if (!again)
        first = place;
      take(place, again ? &*first : nullptr);
      if (++earliest.next == earliest.places.size()) {
        open.pop_back();
        continue;
      }
    }
    std::push_heap(open.begin(), open.end(), later);
  }
}

void ShardIndex::compare_repeated() const {
  Reader reader(set_);
  sweep([&](const Place& place, const Place* first) {
    if (first == nullptr)
      return;
    const std::vector<std::string> names = set_.format().differences(reader.read(*first), reader.read(place));
    if (!names.empty())
      throw InputError(
          fmt::format("{}: experiment {}", reader.path(place).string(), place.outcome.index),
          fmt::format("another {} than in {}", fmt::join(names, ", "), reader.path(*first).string()),
          "the same, bit for bit: they were run by one build on processors of one kind");
  });
}

void ShardIndex::each(const Visit& visit) const {
  Reader reader(set_);
  sweep([&](const Place& place, const Place* first) {
    if (first == nullptr)
      visit(reader.read(place));
  });
}

void ShardIndex::each_repeated(const Visit& visit) const {
  Reader reader(set_);
  sweep([&](const Place& place, const Place* first) {
    if (first != nullptr)
      visit(reader.read(place));
  });
}

}  // namespace mpm
