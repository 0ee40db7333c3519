#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/outcome/outcome_bytes.hpp"
#include "bench/shards/shard_identity.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {

/// Version of the format of a shard; a reader knows its own only.
inline constexpr std::int32_t kShardVersion = 2;

/// Collects the bytes of a shard, finished experiments of a run that is not (docs/running.md). The format:
/// "mpmbench shard" and a line end, version, identity, seconds, the outcomes to the end, all as
/// results/files/byte_stream writes them, and the seal of results/files/file_seal. Bytes and not HDF5,
/// because the reader is the program that wrote them: every number keeps its bits, and there is no second
/// description of a record that could differ from the first.
class ShardBytes {
 public:
  /// One more outcome, as OutcomeBytes has it.
  void add(const std::string& outcome);
  bool empty() const { return outcomes_.empty(); }
  std::size_t size() const { return outcomes_.size(); }

  /// Writes what was added as a shard, all or nothing, and is empty then. Throws ArchiveError when the file
  /// cannot be written; nothing is lost from the object then.
  void write(const std::filesystem::path& path, const ShardIdentity& identity, double seconds);

 private:
  std::string outcomes_;
};

/// A shard that was there a moment ago: its run, which is at work, has packed it into another one or is
/// finished.
class ShardGone : public ArchiveError {
 public:
  explicit ShardGone(const std::filesystem::path& shard);
};

/// Gives the outcomes in a shard one after the other, and returns the wall-clock time that they took, in s;
/// none, and nothing is given, when it is cut off or damaged (its checksum does not fit) or cannot be read.
/// Throws InputError for a whole file that is no shard of this format version and identity, or whose content
/// cannot be read although its checksum fits, and ShardGone.
std::optional<double> read_shard(const std::filesystem::path& path, const ShardIdentity& identity,
                                 const OutcomeBytes& format,
                                 const std::function<void(ExperimentOutcome)>& take);

/// Where in a shard the bytes of an outcome are.
struct OutcomePlace {
  std::int64_t index;
  std::uint64_t begin;
  std::uint32_t size;
};

/// The places of the outcomes in a shard, without a look at what they hold; none, and errors: as
/// read_shard().
std::optional<std::vector<OutcomePlace>> outcome_places(const std::filesystem::path& path,
                                                        const ShardIdentity& identity);

}  // namespace mpm
