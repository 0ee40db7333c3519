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
    const std::optional<double> seconds =
        read_shard(path, identity_, format_, [&](const ExperimentOutcome& outcome) {
          const auto index = static_cast<std::size_t>(outcome.record.draw.index);
          if (index >= done_.size())
            throw InputError(
                "--experiments", fmt::format("{}", done_.size()),
                fmt::format("{} or more, since {} holds experiment {}; or --discard to start anew", index + 1,
                            path.string(), index));
          done_[index] = true;
        });
    if (!seconds) {
      if (warn)
        warn(fmt::format("{}: cut off or damaged, its checksum does not fit; its experiments are run again",
                         path.string()));
      continue;
    }
    shards_.push_back(path);
    seconds_ += *seconds;
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
    const std::optional<double> whole = read_shard(path, identity_, format_, [&](ExperimentOutcome outcome) {
      const auto index = static_cast<std::size_t>(outcome.record.draw.index);
      if (taken[index])
        return;
      taken[index] = true;
      take(std::move(outcome));
    });
    if (!whole)
      throw ArchiveError(fmt::format("{}: cut off or damaged since it was written", path.string()));
  }
}

}  // namespace mpm
