#include "bench/shards/shard_store.hpp"

#include <optional>
#include <utility>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;

}  // namespace

ShardStore::ShardStore(const std::filesystem::path& folder, const RunOptions& options, const Study& study,
                       std::int64_t count, const Warn& warn)
    : folder_(folder),
      identity_(shard_identity(study, options)),
      format_(study),
      interval_(options.shard_interval),
      done_(static_cast<std::size_t>(count)) {
  if (options.leftovers == Leftovers::discard)
    folder_.clear();
  const std::size_t shards = folder_.shards().size();
  if (options.leftovers == Leftovers::refuse && shards > 0)
    throw InputError(folder_.path().string(), fmt::format("{} shards of an interrupted run", shards),
                     "--resume to go on with it, or --discard to delete what it has done");
  take_stock(warn);
}

void ShardStore::take_stock(const Warn& warn) {
  for (const std::filesystem::path& path : folder_.shards()) {
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
    earlier_seconds_ += shard->seconds;
  }
}

std::vector<std::int64_t> ShardStore::missing() const {
  std::vector<std::int64_t> indices;
  for (std::size_t i = 0; i < done_.size(); ++i)
    if (!done_[i])
      indices.push_back(static_cast<std::int64_t>(i));
  return indices;
}

void ShardStore::add(const ExperimentOutcome& outcome) {
  waiting_.add(format_.to_bytes(outcome));
  if (Clock::now() - written_ >= interval_ || waiting_.size() >= kMostBytes)
    flush();
}

void ShardStore::flush() {
  if (waiting_.empty())
    return;
  const std::filesystem::path path = folder_.next();
  const Clock::time_point now = Clock::now();
  waiting_.write(path, identity_, std::chrono::duration<double>(now - written_).count());
  shards_.push_back(path);
  written_ = now;
}

void ShardStore::read(const std::function<void(ExperimentOutcome)>& take) const {
  std::vector<bool> taken(done_.size());
  for (const std::filesystem::path& path : shards_) {
    std::optional<Shard> shard = read_shard(path, identity_, format_);
    if (!shard)
      throw ArchiveError(fmt::format("{}: cut off or damaged since it was written", path.string()));
    for (ExperimentOutcome& outcome : shard->outcomes) {
      const auto index = static_cast<std::size_t>(outcome.record.draw.index);
      if (!taken[index])
        take(std::move(outcome));
      taken[index] = true;
    }
  }
}

}  // namespace mpm
