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

/// What runs several experiments at the same time. `by_solver`: threads for `auto` and `active-set`, whose
/// experiments take milliseconds; processes for the others, because Ipopt with sequential MUMPS is not
/// thread-safe.
enum class Parallel { by_solver, threads, processes };

/// The names of the policies that say which loops are kept.
const std::vector<std::pair<std::string, StorePolicy>>& store_policies();
const std::string& name_of(StorePolicy store);
/// The policy of this name, which was found in `place`. Throws InputError for an unknown name.
StorePolicy store_policy(const std::string& name, const std::string& place);

/// What becomes of the shards of an interrupted run. `renew`: the run resumes them, but discards those of
/// another run.
enum class Leftovers { refuse, resume, discard, renew };

/// How studies are run: filled by the command line, and handed down unchanged to the worker.
struct RunOptions {
  // These decide the results.
  std::optional<std::int64_t> experiments = {};  ///< the first N experiments instead of one full study
  std::optional<std::uint64_t> seed = {};        ///< master seed instead of the study's
  std::vector<std::string> methods = {};     ///< of assessment, instead of the study's; empty: the study's
  std::string solver = "auto";               ///< a name that qp_solver_factory knows
  double audit_share = 0.001;                ///< share of the steps that Ipopt audits; with `auto` only
  StorePolicy store = StorePolicy::flagged;  ///< which loops are kept
  bool allow_unhealthy_basis = false;        ///< run although the basis case fails its self-check
  std::string archive = {};  ///< digest of the archive whose loops are assessed; empty: loops are run
  /// Makes for each worker an assessor that judges its loops instead of the methods of the study; the study
  /// must name the same methods. The study says what the assessor does (TrialPlan::judged). Empty: the
  /// methods see the whole loop.
  std::function<LoopAssessor()> assessor = {};

  // These change no number.
  int jobs = 1;  ///< how many experiments run at once
  Parallel parallel = Parallel::by_solver;
  Leftovers leftovers = Leftovers::refuse;
  /// A shard is written when the last one is this old, in s, >= 0. A killed run loses at most the results of
  /// this time, besides the loops under way. With 2 s, ten hours make 18000 files, which a folder holds well.
  double shard_interval = 2.0;
  /// Where loops, and the answers of methods of this program about them, are kept for the next run; null:
  /// nowhere.
  std::shared_ptr<const CacheFolder> cache = {};
  bool fresh = false;  ///< what the cache keeps is made again
  /// By the name of a method from outside, the option with which its scores are compared
  /// (MethodProgram::threshold_option). The cache keeps no answer of a method from outside that has none.
  std::map<std::string, std::string, std::less<>> threshold_options = {};
};

/// The study as it is run with these options: with their seed, and with all methods spelled out. Throws
/// InputError for an unknown method.
Study study_to_run(Study study, const RunOptions& options);

/// Whether somebody else simulates the plant or is the controller.
bool has_foreign_part(const Study& study);

/// Whether loops run in threads, not in worker processes. With `by_solver`, loops with a foreign part
/// (has_foreign_part()) run in worker processes: they wait for other processes, which must be made while no
/// other thread is at work. Throws InputError for threads if the solver must not run in threads.
bool runs_in_threads(const Study& study, const RunOptions& options);

/// The share of the steps that is audited. It is 0 for a solver other than `auto`, for which there is no
/// audit, and for a controller that is a program, which gives mpmbench no problems to solve.
inline double audited_share(const Study& study, const RunOptions& options) {
  return options.solver == "auto" && !study.controller_program ? options.audit_share : 0.0;
}

}  // namespace mpm
