#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/campaign/campaign_hooks.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/parts/part_folder.hpp"
#include "bench/shards/shard_store.hpp"

namespace mpm {

/// The unfinished pieces of a split run.
struct MissingPieces {
  std::int64_t of = 1;                ///< number of all pieces
  std::vector<std::int64_t> numbers;  ///< in ascending order, from 1 on

  /// The numbers as one asks for a job array: "3,7-9".
  std::string array() const;
};

/// The merged parts of one run.
class PartMerge {
 public:
  /// Looks at the shards of all parts in these folders. Skips a damaged shard with a warning; its loops are
  /// missing. Takes from runs in progress what they have finished so far. Throws InputError for a folder
  /// without parts, and for parts that were not run by this program or that differ from the first one in
  /// study, seed, methods, solver, audit share or store. The number of experiments may differ: the largest
  /// one counts. `methods` are those that the study may name; none: those of this program.
  PartMerge(const std::vector<std::string>& folders, std::shared_ptr<const MethodTable> methods,
            const ShardStore::Warn& warn);

  const Study& study() const { return first_.study; }
  std::int64_t experiments() const { return *first_.options.experiments; }
  /// Of the whole campaign.
  std::int64_t loops() const { return first_.loops; }
  std::size_t part_count() const { return part_count_; }

  /// The loops that no part has.
  LoopRanges missing() const;
  /// The pieces with missing loops; none unless parts are numbered pieces of the whole campaign, split into
  /// one number of pieces.
  std::optional<MissingPieces> missing_pieces() const;

  /// The number of experiments that the parts have, without calibration loops.
  std::int64_t experiments_done() const;

  /// Returns the campaign. Basis case, records and audit are those of a single run_campaign(), bit for bit.
  /// The loops that are missing() have no record, and there is no calibration unless all of its loops are
  /// there. `hooks` see the basis case, and may stop it. The records stay in the shards of the parts, and can
  /// be read as long as this object lives.
  ///
  /// Throws InputError if two parts have different results for one experiment, UnhealthyBasis, Interrupted
  /// and ArchiveError as run_campaign(), ShardGone.
  Campaign merge(const CampaignHooks& hooks) const;

 private:
  void take_stock(const std::vector<std::string>& folders, const ShardStore::Warn& warn);
  void take_part(const std::filesystem::path& folder);

  std::shared_ptr<const MethodTable> methods_;
  PartFolder first_;  ///< with the largest number of experiments
  std::size_t part_count_ = 0;
  std::vector<PartFolder> pieces_;
  std::optional<CampaignLoops> loops_;
  std::optional<ShardStore> store_;
};

}  // namespace mpm
