#include "bench/shards/shard_set.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
ShardSet::ShardSet(const RunOptions& options, const Study& study, std::int64_t count)
    : identity_(shard_identity(study, options)), format_(study), done_(static_cast<std::size_t>(count)) {}

void ShardSet::take_stock(const std::vector<std::filesystem::path>& shards, const Warn& warn) {
  for (const std::filesystem::path& path : shards) {
    const std::optional<Shard> shard = read_shard(path, identity_, format_);
    if (!shard) {
      if (warn)
        warn(fmt::format("{}: cut off or damaged, its checksum does not fit; its experiments are run again",
                         path.string()));
      continue;
    }
    for (const ExperimentOutcome& outcome : shard->outcomes) {
      const auto index = static_cast<std::size_t>(outcome.record.draw.index);
      if (index >= done_.size())
        throw InputError("--experiments", fmt::format("{}", done_.size()),
                         fmt::format("{} or more, since {} holds experiment {}; or --discard to start anew",
                                     index + 1, path.string(), index));
      done_[index] = true;
    }
    shards_.push_back(path);
    seconds_ += shard->seconds;
  }
}

std::vector<std::int64_t> ShardSet::missing() const {
  std::vector<std::int64_t> indices;
  for (std::size_t i = 0; i < done_.size(); ++i)
    if (!done_[i])
      indices.push_back(static_cast<std::int64_t>(i));
  return indices;
}

void ShardSet::read(const Take& take) const {
  std::vector<bool> taken(done_.size());
  for (const std::filesystem::path& path : shards_) {
    std::optional<Shard> shard = read_shard(path, identity_, format_);
    if (!shard)
      throw ArchiveError(fmt::format("{}: cut off or damaged since it was written", path.string()));
    for (ExperimentOutcome& outcome : shard->outcomes) {
      const auto index = static_cast<std::size_t>(outcome.record.draw.index);
      if (taken[index])
        continue;
      taken[index] = true;
      take(std::move(outcome));
    }
  }
}

}  // namespace mpm
