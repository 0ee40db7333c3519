#include "bench/shards/shard_index.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
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

/// Goes through the places of the outcomes in the order of the index, and where several shards have an
/// experiment in the order of these.
class ShardIndex::Sweep {
 public:
  struct Step {
    Place place;
    std::optional<Place> first;  ///< in the first of the shards that have it, where `place` is in another one
  };

  explicit Sweep(const ShardIndex& index) : index_(index), start_(index.starts_.begin()) {}

  /// None behind the last one.
  std::optional<Step> next() {
    while (start_ != index_.starts_.end() && (open_.empty() || *start_ < open_.front().key()))
      open((start_++)->second);
    if (open_.empty())
      return std::nullopt;
    std::pop_heap(open_.begin(), open_.end(), later);
    Open& earliest = open_.back();
    Step step{{earliest.shard, earliest.places[earliest.next]}, std::nullopt};
    if (first_ && first_->outcome.index == step.place.outcome.index)
      step.first = first_;
    else
      first_ = step.place;
    if (++earliest.next == earliest.places.size())
      open_.pop_back();
    else
      std::push_heap(open_.begin(), open_.end(), later);
    return step;
  }

 private:
  struct Open {
    std::size_t shard;
    std::vector<OutcomePlace> places;
    std::size_t next = 0;

    Key key() const { return {places[next].index, shard}; }
  };

  static bool later(const Open& one, const Open& other) { return one.key() > other.key(); }

  void open(std::size_t shard) {
    if (open_.emplace_back(Open{shard, index_.places_in(shard)}).places.empty())
      refuse_changed(index_.set_.shards()[shard]);
    std::push_heap(open_.begin(), open_.end(), later);
  }

  const ShardIndex& index_;
  std::vector<Key>::const_iterator start_;
  std::vector<Open> open_;  // a heap, the earliest one in front
  std::optional<Place> first_;
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

void ShardIndex::compare_repeated() const {
  Reader reader(set_);
  Sweep sweep(*this);
  while (const std::optional<Sweep::Step> step = sweep.next()) {
    if (!step->first)
      continue;
    const std::vector<std::string> names =
        set_.format().differences(reader.read(*step->first), reader.read(step->place));
    if (!names.empty())
      throw InputError(
          fmt::format("{}: experiment {}", reader.path(step->place).string(), step->place.outcome.index),
          fmt::format("another {} than in {}", fmt::join(names, ", "), reader.path(*step->first).string()),
          "the same, bit for bit: they were run by one build on processors of one kind");
  }
}

ShardIndex::Next ShardIndex::one_by_one() const {
  const auto reader = std::make_shared<Reader>(set_);
  const auto sweep = std::make_shared<Sweep>(*this);
  return [reader, sweep]() -> std::optional<ExperimentOutcome> {
    while (const std::optional<Sweep::Step> step = sweep->next())
      if (!step->first)
        return reader->read(step->place);
    return std::nullopt;
  };
}

void ShardIndex::each(const Visit& visit) const {
  const Next next = one_by_one();
  while (const std::optional<ExperimentOutcome> outcome = next())
    visit(*outcome);
}

void ShardIndex::each_repeated(const Visit& visit) const {
  Reader reader(set_);
  Sweep sweep(*this);
  while (const std::optional<Sweep::Step> step = sweep.next())
    if (step->first)
      visit(reader.read(step->place));
}

}  // namespace mpm
