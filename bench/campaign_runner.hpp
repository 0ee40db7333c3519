#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "analysis/experiment/experiment.hpp"
#include "bench/experiment_execution.hpp"
#include "bench/shard_store.hpp"
#include "plants/error.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// What runs experiments at the same time. `by_solver`: threads for `auto` and `active-set`, whose
/// experiments take milliseconds; processes for the others, because Ipopt with sequential MUMPS is not
/// thread-safe.
enum class Parallel { by_solver, threads, processes };

/// How a campaign is run; none of it changes a number of the result but `experiments` and `solver`.
struct CampaignOptions {
  std::optional<std::int64_t> experiments;  ///< the first N experiments instead of one full study
  std::string solver = "auto";              ///< a name that qp_solver_factory knows
  double audit_share = 0.001;               ///< share of the steps that Ipopt audits; with `auto` only
  int jobs = 1;                             ///< how many experiments run at once
  Parallel parallel = Parallel::by_solver;
  StorePolicy store = StorePolicy::flagged;
  bool allow_unhealthy_basis = false;  ///< run although the basis case fails its self-check
  std::optional<ShardOptions> shards;  ///< where finished experiments are kept; in memory only without
  /// Asked at each step of the basis case, and before each experiment; may be empty.
  StopRequest stop;
  /// Called after each experiment that is done, in the order of completion; may be empty.
  std::function<void(const ExperimentRecord&)> on_done;
  /// Called once before the first experiment, with the number of those that an earlier run has left in
  /// shards; may be empty.
  std::function<void(std::int64_t)> on_start;
  /// Called with a text that the user must see; may be empty.
  std::function<void(const std::string&)> on_warning;
};

/// The basis case of the study failed its self-check: its verdicts would mean nothing.
class UnhealthyBasis : public InputError {
 public:
  using InputError::InputError;
};

/// A campaign was stopped before its end. What was finished is in its shards.
class Interrupted : public std::runtime_error {
 public:
  Interrupted(std::int64_t done, std::int64_t count);
};

/// Runs the basis case, checks it, and then the experiments. The records stand in the order of their index;
/// an experiment whose worker process died is marked `failed` and the campaign goes on. Records and audit are
/// the same for any number of jobs, in threads and in processes, and whether the campaign was run in one go
/// or resumed. The shards are still there when it returns: they may go when the archive is written.
///
/// Throws InputError for options that make no campaign (threads for a solver that is not thread-safe),
/// UnhealthyBasis as above (or, when the basis case does not even run through, in any case),
/// Interrupted when a stop was requested, InputError and ArchiveError of ShardStore,
/// std::system_error when no worker process can be made.
Campaign run_campaign(Study study, const CampaignOptions& options);

}  // namespace mpm
