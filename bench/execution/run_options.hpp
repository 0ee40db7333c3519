#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "analysis/experiment/experiment_record.hpp"
#include "analysis/records/trial_record.hpp"

namespace mpm {

class CacheFolder;

/// What runs experiments at the same time. `by_solver`: threads for `auto` and `active-set`, whose
/// experiments take milliseconds; processes for the others, because Ipopt with sequential MUMPS is not
/// thread-safe.
enum class Parallel { by_solver, threads, processes };

/// The names of the choices of which loops are kept.
const std::vector<std::pair<std::string, StorePolicy>>& store_policies();
const std::string& name_of(StorePolicy store);
/// The reverse. Throws InputError for another name, found in `place`.
StorePolicy store_policy(const std::string& name, const std::string& place);

/// What becomes of the shards of an interrupted run; `renew`: they are resumed, and those of another run
/// discarded.
enum class Leftovers { refuse, resume, discard, renew };

/// How studies are run: filled by the command line, and handed down unchanged to the worker.
struct RunOptions {
  // These decide what comes out.
  std::optional<std::int64_t> experiments = {};  ///< the first N experiments instead of one full study
  std::optional<std::uint64_t> seed = {};        ///< master seed instead of the study's
  std::vector<std::string> methods = {};         ///< of assessment instead of the study's; empty: those
  std::string solver = "auto";                   ///< a name that qp_solver_factory knows
  double audit_share = 0.001;                    ///< share of the steps that Ipopt audits; with `auto` only
  StorePolicy store = StorePolicy::flagged;      ///< which loops are kept
  bool allow_unhealthy_basis = false;            ///< run although the basis case fails its self-check
  std::string archive = {};  ///< digest of the archive whose loops are assessed; empty: they are run
  /// Makes for each worker what assesses its loops instead of the methods of the study, which must have
  /// the same; what it does stands in the study (TrialPlan::judged). Empty: the methods see the whole loop.
  std::function<LoopAssessor()> assessor = {};

  // These change no number.
  int jobs = 1;  ///< how many experiments run at once
  Parallel parallel = Parallel::by_solver;
  Leftovers leftovers = Leftovers::refuse;
  /// A shard is written when the last one is this old, in s, >= 0. A run that is killed loses as much at
  /// most, beside what is under way; with 2 s, ten hours make 18000 files, which a folder holds well.
  double shard_interval = 2.0;
  /// Where loops, and what methods of this program say about them, are kept for the next run; null: nowhere.
  std::shared_ptr<const CacheFolder> cache = {};
  bool fresh = false;  ///< what is kept there is made again
  /// Of methods from outside, by name: the option that their scores are compared with
  /// (MethodProgram::threshold_option). Of others no answer is kept there.
  std::map<std::string, std::string, std::less<>> threshold_options = {};
};

/// The study that is run with these options: with their seed and methods, all of them spelled out. Throws
/// InputError for an unknown method.
Study study_to_run(Study study, const RunOptions& options);

/// Whether somebody else simulates the plant or is the controller.
bool has_foreign_part(const Study& study);

/// Whether loops run in threads, or in worker processes: these also where somebody else simulates the plant
/// or is the controller, since such loops wait for other processes, which are made without other threads at
/// work. Throws InputError for threads where the solver must not run in threads.
bool runs_in_threads(const Study& study, const RunOptions& options);

/// The share of the steps that is audited: the other solvers have nothing to be audited by, and a controller
/// that is a program poses no problems.
inline double audited_share(const Study& study, const RunOptions& options) {
  return options.solver == "auto" && !study.controller_program ? options.audit_share : 0.0;
}

}  // namespace mpm
