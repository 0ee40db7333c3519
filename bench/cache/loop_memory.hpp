#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/experiment/experiment_record.hpp"
#include "bench/cache/cache_folder.hpp"
#include "bench/execution/run_options.hpp"
#include "bench/outcome/outcome_bytes.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// A method with a threshold is asked again about every loop whose key is a multiple of this number.
inline constexpr std::int64_t kCheckedLoops = 16;

/// What is known about a loop before it is run.
struct KnownLoop {
  /// The record has its loop if its status is ok, and the answers that are known.
  ExperimentRecord record;
  std::vector<std::string> unheard = {};  ///< methods whose answers are not known
  bool has_truth = true;                  ///< this program has run the whole experiment
  bool by_process = false;                ///< a worker process ran it; one must also ask the methods
  /// Known answers that are asked for again, to check that they are the same (require_expected()).
  std::vector<AssessmentRecord> expected = {};
  double audit_share = 0.0;  ///< share of its steps that were audited
  std::vector<AuditedStep> audited = {};

  /// Throws BrokenPromise if the new answer of a method, unless it failed, differs from the known one in
  /// `expected`.
  void require_expected() const;
};

/// The loops of one campaign that an earlier run has left in a cache, each with its truth, and the answers of
/// the methods of this program about them. They depend on the program with its libraries and processor, on
/// text and seed of the study, on the solver, and on whether loops run in threads or worker processes.
/// Answers of outside programs are not kept, since they may depend on anything, unless the method names its
/// threshold option (RunOptions::threshold_options): then its answers are kept for every threshold, and it is
/// asked again about one loop in kCheckedLoops. A failure that may be a matter of time is not kept either.
class LoopMemory {
 public:
  /// Whether the loops of this campaign may be kept. They may not if the plant or the controller is somebody
  /// else's, if RunOptions::assessor assesses them, or if the archive stores loops.
  static bool may_keep(const Study& study, const RunOptions& options);

  /// `study` and `calibration`, which is null if the campaign has none, must outlive this object.
  LoopMemory(const Study& study, const Study* calibration, const RunOptions& options);
  LoopMemory(const LoopMemory&) = delete;
  LoopMemory& operator=(const LoopMemory&) = delete;

  /// Returns the loop with this key of CampaignLoops, with its truth and the audit of its steps; none if it
  /// has to be run. May be called from any thread.
  std::optional<KnownLoop> find(std::int64_t key) const;
  /// The same for an experiment of an archive, which has the truth already; none if the kept record differs
  /// in anything from that of the archive.
  std::optional<KnownLoop> find_same(std::int64_t key, const ExperimentRecord& record) const;

  /// Returns the bytes to keep of a loop that was not known, with its answers; empty if there is nothing to
  /// keep.
  std::string to_keep(std::int64_t key, const KnownLoop& loop) const;
  /// The same for a known loop, once the methods in `unheard` have answered.
  std::string to_keep(const KnownLoop& known) const;
  /// Takes bytes from to_keep(). One call at a time; find() may run meanwhile, but does not find them.
  void take(std::int64_t key, std::string bytes);

  /// Writes new results into the cache. If that fails, returns the reason, the first time only.
  std::optional<std::string> write();

 private:
  using Answers = std::map<std::string, std::string, std::less<>>;  ///< bytes by method

  /// How the answers of a method are kept.
  struct Kept {
    std::string name = {};  ///< of the method, with all else that its answers depend on; empty: not kept
    std::optional<double> threshold = {};  ///< with which kept answers are flagged anew
  };
  using NamedAnswers = std::vector<std::pair<std::string, std::string>>;

  static Kept kept_as(const MethodDescription& method, const RunOptions& options);
  NamedAnswers answers_to_keep(const ExperimentRecord& record, const std::vector<std::string>& asked,
                               bool by_process) const;
  const OutcomeBytes& bytes_of(std::int64_t key) const;
  double audit_share_of(std::int64_t key) const;
  std::optional<KnownLoop> kept_loop(std::int64_t key) const;
  KnownLoop known_loop(std::int64_t key, const std::string& loop) const;
  void read();
  void merge(std::int64_t key, const std::string& bytes);

  std::shared_ptr<const CacheFolder> folder_;
  ShardIdentity loop_identity_, answer_identity_;
  AssessmentForms forms_;
  std::map<std::string, Kept, std::less<>> kept_;  ///< by method
  OutcomeBytes bytes_;
  std::optional<OutcomeBytes> calibration_bytes_;
  double audit_share_;  ///< of the experiments of this campaign
  std::map<std::int64_t, std::string> loops_;
  std::map<std::int64_t, Answers> answers_;
  std::size_t held_ = 0;  ///< bytes
  std::vector<std::pair<std::int64_t, std::string>> taken_;
  bool new_loops_ = false, new_answers_ = false;
};

/// Writes new results into the cache when its scope ends, also by an exception, so that the work of an
/// interrupted run is kept as well. `warn`, unless it is empty, receives the reason if that fails.
class KeepAtEnd {
 public:
  KeepAtEnd(LoopMemory* memory, std::function<void(const std::string&)> warn)
      : memory_(memory), warn_(std::move(warn)) {}
  ~KeepAtEnd();
  KeepAtEnd(const KeepAtEnd&) = delete;
  KeepAtEnd& operator=(const KeepAtEnd&) = delete;

 private:
  LoopMemory* memory_;
  std::function<void(const std::string&)> warn_;
};

}  // namespace mpm
