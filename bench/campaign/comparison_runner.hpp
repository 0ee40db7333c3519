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

/// Returns the methods of a study, each with this program and the command line `command`, which assess its
/// loops now.
std::vector<CampaignMethod> methods_of(const Study& study, const std::string& command);

struct ComparisonOptions {
  std::vector<std::string> methods;                  ///< names that are valid in the study, each once
  int jobs = 1;                                      ///< how many loops are assessed at once
  std::optional<PartNumber> part = {};               ///< which part of the loops is assessed; none: all
  std::string archive = {};                          ///< digest of the archive whose loops are assessed
  std::optional<std::filesystem::path> shards = {};  ///< where the answers wait; none: in memory
  ShardStore::Options kept = {};                     ///< how to open this folder
  std::vector<std::filesystem::path> parts = {};     ///< folders of shards from finished parts
  std::shared_ptr<const CacheFolder> cache = {};     ///< as in RunOptions
  bool fresh = false;                                ///< the same
  std::map<std::string, std::string, std::less<>> threshold_options = {};  ///< the same
};

/// The loops and methods of a comparison.
struct ComparedLoops {
  std::vector<std::int64_t> experiments;  ///< indices with status ok, among the first experiments asked for
  std::int64_t end = 0;                   ///< one past the last index of the campaign
  std::vector<std::string> missing;       ///< methods that lack an answer on some of these experiments
};

/// Returns the loops of a comparison on the first `experiments`, and the methods among `asked` that are
/// missing.
ComparedLoops compared_loops(const Campaign& campaign, const std::vector<std::string>& asked,
                             const std::optional<std::int64_t>& experiments);

/// Assesses the experiments with status ok, and the calibration loops, by further methods. The answers are
/// the same for any number of jobs and however often the work was stopped, except for the processor times. A
/// loop that was not stored is run again with the solver of the campaign (run_revisited()).
class Comparison {
 public:
  /// Prepares to assess these loops of the campaign, which must outlive run(). Errors: as
  /// CampaignLoops::open().
  Comparison(const Campaign& campaign, const ComparedLoops& loops, const ComparisonOptions& options);
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  /// The number of loops to assess, whether they have been assessed or not.
  std::int64_t count() const { return std::ssize(keys_); }

  /// Assesses the loops that have no answers yet. An experiment that kills its worker processes gets failed
  /// answers with the reason. Throws Interrupted; InputError for an unknown method, or for options that do
  /// not fit the study, as found on its first loop.
  void run(const CampaignHooks& hooks);

  /// Makes as few shards as there can be.
  void compact() { store_.compact(); }

  /// Appends the answers, which must all be there, to those of the other methods of the campaign. Replaces
  /// answers that the campaign already has of one of these methods, such as on its first experiments only.
  /// Streamed records get their answers from the shards when they are read, so the campaign must not be read
  /// after the comparison is gone; reading it throws Interrupted if a stop was requested. Errors: as
  /// ShardStore::Next.
  void add_to(Campaign& campaign, const std::string& command, const StopRequest& stop = {});

 private:
  /// The result to store: of an experiment, with the answers that assess(record) gives, or of a calibration
  /// loop.
  template <class Assess>
  LoopResult kept_answers(std::int64_t key, ExperimentRecord record, const Assess& assess) const;
  std::vector<AssessmentRecord> lost_answers(const std::string& why) const;

  const Campaign& campaign_;
  CampaignLoops loops_;  ///< with the methods of the comparison
  ShardStore store_;
  std::vector<std::int64_t> keys_;
};

/// Puts these loops, as methods see them, into the store: the key of a loop is its place in `order`. Runs
/// loops again that the archive has not kept. A calibration loop that does not run to its end has no samples.
/// In worlds each loop gets a benchmark of its own (ExperimentRunner::benchmark_of()): a benchmark that all
/// loops of a world share would tell which loops belong together and, by their number, which of them
/// calibrate thresholds.
void run_blind_loops(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
                     const CampaignHooks& hooks, ShardStore& store);

/// Reads the loops of run_blind_loops() from the store, in the order of `order`.
BlindLoops blind_loops_in(const ShardStore& store, std::size_t count);
/// Reads their benchmarks in worlds, likewise.
BlindLoops blind_benchmarks_in(const ShardStore& store, std::size_t count);

/// Appends verdicts from outside to the answers of the methods of the campaign, and replaces those of a
/// method of the same name.
void add_verdicts(Campaign& campaign, OutsideVerdicts verdicts, const std::string& command);

/// Returns the campaign, streamed or not, with only these of its methods, in this order, and only their
/// answers on its first `experiments`.
Campaign with_methods(Campaign campaign, const std::vector<std::string>& methods,
                      const std::optional<std::int64_t>& experiments);

}  // namespace mpm
