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

/// Loops of a finished campaign that are taken up once more: experiments as its records have them,
/// calibration loops run again. All that is referred to must outlive run_revisited().
struct RevisitedLoops {
  const Campaign& campaign;
  const Study& study;                ///< of the experiments
  const Study* calibration;          ///< of the calibration loops; null: none is wanted
  std::vector<std::string> methods;  ///< that runners assess with
  StorePolicy calibration_store;     ///< data that a calibration loop keeps when it is run again
  /// Of a key. Keys of experiments come in ascending order of the index.
  std::function<LoopPlace(std::int64_t key)> place;
  /// What is kept of a loop. `runner` has the methods; what it does is a function of the loop alone. A record
  /// that has answers has those of all methods.
  std::function<LoopResult(std::int64_t key, ExperimentRunner& runner, ExperimentRecord record)> make;
  /// What is kept of a loop over which two worker processes died, `why`. The record of a calibration loop has
  /// nothing but its draw and the status `failed`.
  std::function<LoopResult(std::int64_t key, ExperimentRecord record, const std::string& why)> lost;
  /// What earlier runs have left of loops whose keys are those of CampaignLoops, with what methods said; what
  /// is new goes there. Null: nothing.
  LoopMemory* memory = nullptr;
};

/// Runs what the store lacks of these keys, as run_missing(): in threads by the active-set method, and in
/// worker processes where a loop has to be simulated by Ipopt, whose linear solver must not run in two
/// threads. The store has the same bytes for any number of jobs.
void run_revisited(ShardStore& store, const std::vector<std::int64_t>& keys, const RevisitedLoops& loops,
                   int jobs, const CampaignHooks& hooks);

}  // namespace mpm
