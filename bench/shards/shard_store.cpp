#include "bench/shards/shard_store.hpp"

#include <utility>

#include <fmt/format.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kPackedBytes = std::size_t{4} << 20;  // whoever reads a shard has all of it in memory

std::uintmax_t bytes_of(const std::vector<std::filesystem::path>& files) {
  std::uintmax_t bytes = 0;
  for (const std::filesystem::path& file : files)
    bytes += std::filesystem::file_size(file);
  return bytes;
}

}  // namespace

ShardStore::ShardStore(const std::filesystem::path& folder, const RunOptions& options, const Study& study,
                       std::int64_t count, const Warn& warn)
    : folder_(folder), set_(options, study, count), interval_(options.shard_interval) {
  if (options.leftovers == Leftovers::discard)
    folder_.clear();
  const std::size_t shards = folder_.shards().size();
  if (options.leftovers == Leftovers::refuse && shards > 0)
    throw InputError(folder_.path().string(), fmt::format("{} shards of an earlier run", shards),
                     "--resume to go on with it, or --discard to delete what it has done");
  set_.take_stock(folder_.shards(), warn);
}

void ShardStore::add(const ExperimentOutcome& outcome) {
  waiting_.add(set_.format().to_bytes(outcome));
  if (Clock::now() - written_ >= interval_ || waiting_.size() >= kMostBytes)
    flush();
}

void ShardStore::flush() {
  if (waiting_.empty())
    return;
  const std::filesystem::path path = folder_.next();
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - written_).count();
  waiting_.write(path, set_.identity(), seconds);
  set_.add_written(path, seconds);
  written_ = now;
}

void ShardStore::compact() {
  const std::vector<std::filesystem::path> before = folder_.shards();
  if (before.size() <= 1 + bytes_of(before) / kPackedBytes)
    return;
  ShardBytes packed;
  std::vector<std::filesystem::path> after;
  double seconds = set_.seconds();  // all of it in the first one
  const auto write = [&] {
    after.push_back(folder_.next());
    packed.write(after.back(), set_.identity(), std::exchange(seconds, 0.0));
  };
  set_.read([&](const ExperimentOutcome& outcome) {
    packed.add(set_.format().to_bytes(outcome));
    if (packed.size() >= kPackedBytes)
      write();
  });
  if (!packed.empty())
    write();
  set_.replace_shards(std::move(after));
  for (const std::filesystem::path& shard : before)
    std::filesystem::remove(shard);
}

}  // namespace mpm
