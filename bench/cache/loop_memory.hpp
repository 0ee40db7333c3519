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

/// A method with a threshold is asked again about every loop whose key is a multiple of it.
inline constexpr std::int64_t kCheckedLoops = 16;

/// What is known about a loop before it is run.
struct KnownLoop {
  /// With its loop where its status is ok, and with the answers that are known.
  ExperimentRecord record;
  std::vector<std::string> unheard = {};  ///< methods whose answers are not known
  bool has_truth = true;                  ///< of an experiment that this program has run as a whole
  bool by_process = false;                ///< a worker process ran it, as the methods are to be asked by one
  /// Known answers that are asked for again, to check that they are the same (require_expected()).
  std::vector<AssessmentRecord> expected = {};
  double audit_share = 0.0;  ///< of its steps that were audited
  std::vector<AuditedStep> audited = {};

  /// Throws BrokenPromise where a method has answered otherwise than with the threshold that it had before.
  void require_expected() const;
};

/// The loops of one campaign that an earlier run has left in a cache, each with its truth, and what methods
/// of this program have said about them: what decides on them is the program with the libraries and the
/// processor that it runs on, text and seed of the study, the solver, and whether threads or worker processes
/// run. Answers of outside programs are not kept, since they may depend on anything, unless the method says
/// what its threshold is (RunOptions::threshold_options): then they are kept for every threshold, and one
/// loop in kCheckedLoops is asked again. Nor is anything that has failed, since that may be a matter of time.
class LoopMemory {
 public:
  /// Whether the loops of this campaign may be kept: some have a plant or a controller of somebody else, or
  /// are assessed by what RunOptions::assessor makes.
  static bool may_keep(const Study& study, const RunOptions& options);

  /// Of a campaign whose study and calibration study, or null, must outlive it.
  LoopMemory(const Study& study, const Study* calibration, const RunOptions& options);
  LoopMemory(const LoopMemory&) = delete;
  LoopMemory& operator=(const LoopMemory&) = delete;

  /// The loop with this key of CampaignLoops, with its truth and the audit of its steps; none: it has to be
  /// run. From any thread.
  std::optional<KnownLoop> find(std::int64_t key) const;
  /// The same for an experiment of an archive, whose truth is there; none where the record differs from that
  /// of the archive in anything.
  std::optional<KnownLoop> find_same(std::int64_t key, const ExperimentRecord& record) const;

  /// What is to be kept of a loop that was not known, with its answers, as bytes. Empty: nothing.
  std::string to_keep(std::int64_t key, const KnownLoop& loop) const;
  /// The same of one that was known, once the methods that were not heard have answered.
  std::string to_keep(const KnownLoop& known) const;
  /// Takes such bytes. One call at a time; find() may run beside it, and does not find them.
  void take(std::int64_t key, std::string bytes);

  /// Writes new results into the cache. Returns, the first time, the reason if that fails.
  std::optional<std::string> write();

 private:
  using Answers = std::map<std::string, std::string, std::less<>>;  ///< bytes by method

  /// How the answers of a method are kept.
  struct Kept {
    std::string name = {};  ///< its own, with everything else that the answers depend on; empty: not kept
    std::optional<double> threshold = {};  ///< by which their flags are made anew
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

/// Leaves what is new in the cache when its scope ends, also by an exception: what an interrupted run has
/// done is kept as well. `warn`, unless it is empty, receives the reason if that cannot be done.
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
