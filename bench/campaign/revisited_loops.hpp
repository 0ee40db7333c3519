#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "bench/campaign/campaign_hooks.hpp"
#include "bench/campaign/loop_farm.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

class LoopMemory;

/// An experiment of a run, or one of its calibration loops.
struct LoopPlace {
  std::int64_t index = 0;
  bool of_calibration = false;
};

/// Loops of a finished campaign that are used once more: experiments as its records have them, and
/// calibration loops, which are run again. Everything that this struct refers to must outlive
/// run_revisited().
struct RevisitedLoops {
  const Campaign& campaign;
  const Study& study;                ///< of the experiments
  const Study* calibration;          ///< of the calibration loops; null: none is wanted
  std::vector<std::string> methods;  ///< with which the runners assess
  StorePolicy calibration_store;     ///< data that a calibration loop keeps when it is run again
  /// The loop of a key. Keys of experiments must be in ascending order of the index.
  std::function<LoopPlace(std::int64_t key)> place;
  /// Returns what to store of a loop. `runner` has the methods; what it does is a function of the loop alone.
  /// A record that has answers has those of all methods.
  std::function<LoopResult(std::int64_t key, ExperimentRunner& runner, ExperimentRecord record)> make;
  /// Returns what to store of a loop that killed two worker processes, `why`. The record of a calibration
  /// loop has nothing but its draw and the status `failed`.
  std::function<LoopResult(std::int64_t key, ExperimentRecord record, const std::string& why)> lost;
  /// Loops that earlier runs have left, under the keys of CampaignLoops, with the answers of methods. New
  /// results go into it. Null: nothing is known or kept.
  LoopMemory* memory = nullptr;
};

/// Runs the loops with these keys that the store lacks, as run_missing(): in threads with the active-set
/// method, and in worker processes where Ipopt has to simulate a loop, because its linear solver must not run
/// in two threads. The store has the same bytes for any number of jobs.
void run_revisited(ShardStore& store, const std::vector<std::int64_t>& keys, const RevisitedLoops& loops,
                   int jobs, const CampaignHooks& hooks);

}  // namespace mpm
