#include "bench/campaign/revisited_loops.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "analysis/methods/ours/learnt_context.hpp"
#include "base/error.hpp"
#include "base/system/program_trust.hpp"
#include "bench/cache/loop_memory.hpp"
#include "bench/campaign/campaign_loops.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/execution/thread_worker.hpp"
#include "results/archive/record_bytes.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

/// Prepares the processes of a plant that somebody else simulates, before threads are at work. If its file is
/// gone or not trusted, this matters only to loops that are run again, and they report it.
void prepare_plant(const Study& study) {
  if (!study.nonlinear || !study.nonlinear->model.foreign)
    return;
  try {
    study.nonlinear->model.foreign->load();
  } catch (const InputError&) {
  } catch (const UntrustedProgram&) {
  }
}

/// Records for threads, each of which asks for the next record or one soon after it. Reads them one after the
/// other, and holds in memory those that a thread will ask for soon, or once more.
class RecordsInTurn {
 public:
  /// Gives the records with these indices, which must exist and be in ascending order. `records` must outlive
  /// this object.
  RecordsInTurn(const RecordRange& records, std::vector<std::int64_t> indices)
      : next_(records.one_by_one()), indices_(std::move(indices)), wanted_(indices_.begin()) {}
  RecordsInTurn(const RecordsInTurn&) = delete;
  RecordsInTurn& operator=(const RecordsInTurn&) = delete;

  /// Returns the record with this index, which must not have been dropped.
  ExperimentRecord get(std::int64_t index) {
    const std::lock_guard one_at_a_time(mutex_);
    while (read_.count(index) == 0) {
      const ExperimentRecord& record = *next_();
      if (record.draw.index == *wanted_)
        read_.emplace(*wanted_++, record);
    }
    return read_.at(index);
  }

  void drop(std::int64_t index) {
    const std::lock_guard one_at_a_time(mutex_);
    read_.erase(index);
  }

 private:
  RecordRange::Next next_;
  std::vector<std::int64_t> indices_;
  std::vector<std::int64_t>::const_iterator wanted_;
  std::map<std::int64_t, ExperimentRecord> read_;
  std::mutex mutex_;
};

/// What one thread or process works with.
struct LoopRunners {
  LoopRunners(const RevisitedLoops& loops, const QpSolverFactory& factory)
      : experiments(loops.study, context(loops, factory), loops.methods) {
    if (loops.calibration != nullptr)
      calibration.emplace(*loops.calibration, context(loops, factory), loops.methods);
  }

  static AssessmentContext context(const RevisitedLoops& loops, const QpSolverFactory& factory) {
    return assessment_context(loops.campaign.study, loops.campaign.basis, factory);
  }

  ExperimentRunner experiments;
  std::optional<ExperimentRunner> calibration;
};

class Revisit {
 public:
  Revisit(const RevisitedLoops& loops, const std::vector<std::int64_t>& missing)
      : loops_(loops),
        solver_(loops.campaign.info.solver),
        bytes_(loops.campaign.study, AssessmentForms{}),
        records_(records_of(loops.campaign), experiments_of(missing)) {}

  LoopWork work(int jobs, const CampaignHooks& hooks) {
    LoopWork work{.jobs = jobs,
                  .stop = hooks.stop,
                  .on_start = hooks.on_start,
                  .on_done = hooks.on_done,
                  .on_warning = hooks.on_warning};
    if (loops_.memory != nullptr)
      work.on_aside = [this](std::int64_t key, std::string aside) {
        loops_.memory->take(key, std::move(aside));
      };
    work.thread = [this] {
      const auto make = [this](const QpSolverFactory& factory) {
        return std::make_unique<LoopRunners>(loops_, factory);
      };
      return [this, runners = std::make_shared<ThreadWorker<LoopRunners>>(make, has_processes_)](
                 std::int64_t key) { return in_thread(key, *runners); };
    };
    if (has_processes_)
      work.process = [this, runners = std::make_shared<LoopRunners>(loops_, qp_solver_factory(solver_))](
                         std::int64_t key, const std::string& begun) {
        return in_process(key, begun, *runners);
      };
    work.lost = [this](std::int64_t key, const std::string& begun, const std::string& why,
                       bool again) -> std::optional<LoopResult> {
      if (!again)
        return std::nullopt;
      const LoopPlace place = loops_.place(key);
      return loops_.lost(key,
                         place.of_calibration ? lost_record(*loops_.calibration, place.index, why)
                                              : bytes_.from_bytes(begun),
                         why);
    };
    return work;
  }

 private:
  std::vector<std::int64_t> experiments_of(const std::vector<std::int64_t>& keys) const {
    std::vector<std::int64_t> indices;
    for (const std::int64_t key : keys)
      if (const LoopPlace place = loops_.place(key); !place.of_calibration)
        indices.push_back(place.index);
    return indices;
  }

  LoopResult in_thread(std::int64_t key, ThreadWorker<LoopRunners>& runners) {
    const LoopPlace place = loops_.place(key);
    if (place.of_calibration) {
      std::optional<LoopResult> result;
      if (!by_ipopt_alone_ || known_calibration(key))
        result = runners.run([&](LoopRunners& each) { return calibrated(key, place, each); });
      return result ? *std::move(result) : LoopResult{.bytes = "", .unfinished = true};
    }
    ExperimentRecord record = records_.get(place.index);
    record.assessments.clear();
    const std::optional<LoopResult> result = runners.run([&](LoopRunners& each) -> LoopResult {
      if (by_ipopt_alone_ && each.experiments.runs_loops(record))
        return for_process(record);
      return assessed(key, each.experiments, record, false);
    });
    records_.drop(place.index);
    return result ? *result : for_process(record);
  }

  LoopResult for_process(const ExperimentRecord& record) const {
    return {.bytes = bytes_.to_bytes(record), .unfinished = true};
  }

  /// The result of a calibration loop in a thread. A failed loop goes to a worker process: it may have needed
  /// Ipopt.
  LoopResult calibrated(std::int64_t key, const LoopPlace& place, LoopRunners& runners) const {
    LoopResult none{.bytes = "", .unfinished = true};
    if (std::optional<KnownLoop> known = known_calibration(key))
      return known->by_process && !known->unheard.empty()
                 ? none
                 : heard(key, *runners.calibration, *std::move(known));
    ExperimentRecord record = runners.calibration->run(place.index, calibration_store());
    return has_processes_ && record.status == ExperimentStatus::failed
               ? none
               : made(key, *runners.calibration, {.record = std::move(record)});
  }

  LoopResult in_process(std::int64_t key, const std::string& begun, LoopRunners& runners) const {
    const LoopPlace place = loops_.place(key);
    if (!place.of_calibration)
      return assessed(key, runners.experiments, bytes_.from_bytes(begun), true);
    if (std::optional<KnownLoop> known = known_calibration(key)) {
      known->by_process = true;  // a process gives the new answers
      return heard(key, *runners.calibration, *std::move(known));
    }
    return made(key, *runners.calibration,
                {.record = runners.calibration->run(place.index, calibration_store()), .by_process = true});
  }

  StorePolicy calibration_store() const {
    return loops_.memory == nullptr ? loops_.calibration_store : StorePolicy::all;
  }

  std::optional<KnownLoop> known_calibration(std::int64_t key) const {
    return loops_.memory == nullptr ? std::nullopt : loops_.memory->find(key);
  }

  /// The result of an experiment. Its loop is run unless the record has it or the memory knows it.
  LoopResult assessed(std::int64_t key, ExperimentRunner& runner, ExperimentRecord record,
                      bool by_process) const {
    if (loops_.memory == nullptr || record.loop || record.status != ExperimentStatus::ok)
      return loops_.make(key, runner, std::move(record));
    if (std::optional<KnownLoop> known = loops_.memory->find_same(key, record)) {
      known->by_process |= by_process;
      return heard(key, runner, *std::move(known));
    }
    KnownLoop loop{.record = std::move(record), .has_truth = false, .by_process = by_process};
    loop.record.loop = {runner.simulated(loop.record.draw), {}};
    loop.record.assessments = runner.assess(loop.record);
    return made(key, runner, std::move(loop));
  }

  /// The result of a loop that was not known and has its answers now.
  LoopResult made(std::int64_t key, ExperimentRunner& runner, KnownLoop loop) const {
    std::string aside = loops_.memory == nullptr ? "" : loops_.memory->to_keep(key, loop);
    LoopResult result = loops_.make(key, runner, std::move(loop.record));
    result.aside = std::move(aside);
    return result;
  }

  LoopResult heard(std::int64_t key, ExperimentRunner& runner, KnownLoop known) const {
    if (!known.unheard.empty())
      put_answers(runner.assess(known.record, known.unheard), known.record);
    known.require_expected();
    std::string aside = loops_.memory->to_keep(known);
    LoopResult result = loops_.make(key, runner, std::move(known.record));
    result.aside = std::move(aside);
    return result;
  }

  const RevisitedLoops& loops_;
  std::string solver_;
  bool has_processes_ = solver_ != "active-set";
  bool by_ipopt_alone_ = solver_ != "auto" && solver_ != "active-set";
  RecordBytes bytes_;  ///< of records without answers: nobody reads earlier answers
  RecordsInTurn records_;
};

}  // namespace

void run_revisited(ShardStore& store, const std::vector<std::int64_t>& keys, const RevisitedLoops& loops,
                   int jobs, const CampaignHooks& hooks) {
  prepare_plant(loops.campaign.study);
  Revisit revisit(loops, store.missing(keys));
  run_missing(store, keys, revisit.work(std::max(1, jobs), hooks));
}

}  // namespace mpm
