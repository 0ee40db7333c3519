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
  std::int64_t of = 1;                ///< pieces
  std::vector<std::int64_t> numbers;  ///< in ascending order, from 1 on

  /// As job arrays are asked for: "3,7-9".
  std::string array() const;
};

/// The merged parts of one run.
class PartMerge {
 public:
  /// Looks at the shards of all parts in these folders. A damaged shard is passed over with a warning, what
  /// it holds is missing; of runs at work, what they have finished by now. Throws InputError for a folder
  /// without parts, and for parts that were not run by this program, or not with the study, seed, methods,
  /// solver, audit share and store of the first one; the number of experiments may differ, the largest one
  /// counts. `methods` are those that the study may name; none: those of this program.
  PartMerge(const std::vector<std::string>& folders, std::shared_ptr<const MethodTable> methods,
            const ShardStore::Warn& warn);

  const Study& study() const { return first_.study; }
  std::int64_t experiments() const { return *first_.options.experiments; }
  /// Of the whole campaign.
  std::int64_t loops() const { return first_.loops; }
  std::size_t part_count() const { return part_count_; }

  /// The loops that no part has.
  LoopRanges missing() const;
  /// The same in pieces, as long as some part is a piece of the whole campaign, and all of these are of
  /// equally many.
  std::optional<MissingPieces> missing_pieces() const;

  /// How many experiments the parts have, calibration loops apart.
  std::int64_t experiments_done() const;

  /// The campaign: basis case, records and audit are those of run_campaign() in one go, bit for bit. Of what
  /// is missing() there is no record, and no calibration unless all of its loops are there. `hooks` see the
  /// basis case, and may stop it. The records stay in the shards of the parts, and are there as long as this
  /// object.
  ///
  /// Throws InputError when two parts have the same experiment with another result, UnhealthyBasis,
  /// Interrupted and ArchiveError as run_campaign(), ShardGone.
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
