#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/methods/assessed_loop.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/shards/shard_store.hpp"
#include "results/archive/campaign.hpp"
#include "results/blind/blind_loops.hpp"
#include "results/blind/verdict_file.hpp"

namespace mpm {

/// The methods of a study as they assess its loops now, by this program and the command line `command`.
std::vector<CampaignMethod> methods_of(const Study& study, const std::string& command);

struct ComparisonOptions {
  std::vector<std::string> methods;                  ///< names that the study may have, each once
  int jobs = 1;                                      ///< how many loops are assessed at once
  std::optional<PartNumber> part = {};               ///< which part of the loops is assessed; none: all
  std::string archive = {};                          ///< digest of the archive whose loops are assessed
  std::optional<std::filesystem::path> shards = {};  ///< where the answers wait; none: in memory
  ShardStore::Options kept = {};                     ///< of this folder
  std::vector<std::filesystem::path> parts = {};     ///< folders of shards that others have left
  std::shared_ptr<const CacheFolder> cache = {};     ///< as RunOptions has it
  bool fresh = false;                                ///< the same
  std::map<std::string, std::string, std::less<>> threshold_options = {};  ///< the same
};

/// The loops and methods of a comparison.
struct ComparedLoops {
  std::vector<std::int64_t> experiments;  ///< indices of those with status ok, among the first ones asked for
  std::int64_t end = 0;                   ///< behind the last index of the campaign
  std::vector<std::string> missing;       ///< methods that the campaign does not have on all of them
};

/// The loops of a comparison on the first `experiments`, and those of the methods `asked` that are missing.
ComparedLoops compared_loops(const Campaign& campaign, const std::vector<std::string>& asked,
                             const std::optional<std::int64_t>& experiments);

/// Methods that assess the experiments with status ok, and the calibration loops; the same answer for any
/// number of jobs, and however often it was stopped, except for the processor times. A loop that was not
/// stored is run again by the solver of the campaign (run_revisited).
class Comparison {
 public:
  /// On these loops of the campaign, which must outlive run(). Errors: as CampaignLoops::open().
  Comparison(const Campaign& campaign, const ComparedLoops& loops, const ComparisonOptions& options);
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  /// How many loops are wanted.
  std::int64_t count() const { return std::ssize(keys_); }

  /// Assesses those that are missing. An experiment over which worker processes die has failed answers, with
  /// the reason. Throws Interrupted, and InputError for an unknown method, or options that do not fit the
  /// study: that of its first loop.
  void run(const CampaignHooks& hooks);

  /// Makes as few shards as there can be.
  void compact() { store_.compact(); }

  /// Puts the answers, which must all be there, behind those of the other methods of the campaign; answers
  /// that it has of one of them, such as on its first experiments only, are replaced. To records that are
  /// streamed they come when these are read, from the shards: the campaign must not be read when the
  /// comparison is gone. It then throws Interrupted when a stop was requested. Errors: as ShardStore::Next.
  void add_to(Campaign& campaign, const std::string& command, const StopRequest& stop = {});

 private:
  /// The bytes of an experiment with the answers that assess(record) gives, or of a calibration loop.
  template <class Assess>
  LoopResult kept_answers(std::int64_t key, ExperimentRecord record, const Assess& assess) const;
  std::vector<AssessmentRecord> lost_answers(const std::string& why) const;

  const Campaign& campaign_;
  CampaignLoops loops_;  ///< with the methods of the comparison
  ShardStore store_;
  std::vector<std::int64_t> keys_;
};

/// Keeps these loops, as methods see them, in the store: key `number` for the loop in that place of `order`.
/// Loops are run again where they were not kept. Without samples: a calibration loop that does not run to its
/// end. In worlds each loop gets a benchmark of its own (ExperimentRunner::benchmark_of()): one for all loops
/// of a world would tell which of them belong together, and by their number which calibrate thresholds.
void run_blind_loops(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
                     const CampaignHooks& hooks, ShardStore& store);

/// Those loops again, in the order of their numbers, each there until the next one is read.
BlindLoops blind_loops_in(const ShardStore& store, std::size_t count);
/// Their benchmarks in worlds, likewise.
BlindLoops blind_benchmarks_in(const ShardStore& store, std::size_t count);

/// Puts verdicts from outside behind the answers of the methods that the campaign has, and replaces answers
/// of the same name.
void add_verdicts(Campaign& campaign, OutsideVerdicts verdicts, const std::string& command);

/// The campaign, streamed or not, with these of its methods alone, in this order, on its first `experiments`.
Campaign with_methods(Campaign campaign, const std::vector<std::string>& methods,
                      const std::optional<std::int64_t>& experiments);

}  // namespace mpm
