#include "bench/campaign/comparison_runner.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <tuple>
#include <type_traits>
#include <utility>

#include "analysis/methods/method_table.hpp"
#include "bench/campaign/calibration_runs.hpp"
#include "bench/execution/experiment_execution.hpp"
#include "bench/execution/thread_loop.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "plants/system/program_trust.hpp"
#include "scenarios/loop/calibration.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {
namespace {

bool is_compared(const ExperimentRecord& record, const std::optional<std::int64_t>& experiments) {
  return record.status == ExperimentStatus::ok && (!experiments || record.draw.index < *experiments);
}

/// Changes every record, at once, or those that are streamed whenever they are read.
void change_records(Campaign& campaign, const std::function<RecordChange()>& begin) {
  if (campaign.streamed) {
    campaign.streamed = changed(*campaign.streamed, begin);
    return;
  }
  const RecordChange change = begin();
  for (ExperimentRecord& record : campaign.records)
    change(record);
}

/// Of a list, what stands at these places.
template <class List>
List chosen(const List& all, const std::vector<std::size_t>& places) {
  List list;
  for (const std::size_t place : places)
    list.push_back(all[place]);
  return list;
}

/// The places of the methods of a campaign that are none of these.
std::vector<std::size_t> places_of_others(const Campaign& campaign, const AssessmentForms& forms) {
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < campaign.methods.size(); ++place)
    if (std::none_of(forms.begin(), forms.end(), [&](const auto& form) {
          return form->method().name == campaign.methods[place].form->method().name;
        }))
      places.push_back(place);
  return places;
}

/// Where somebody else simulates the plant, its processes have to be prepared before threads are at work. Its
/// file may be gone, or not be trusted: that matters to the loops that are run again, which then say so.
void prepare_plant(const Study& study) {
  if (!study.nonlinear || !study.nonlinear->model.foreign)
    return;
  try {
    study.nonlinear->model.foreign->load();
  } catch (const InputError&) {
  } catch (const UntrustedProgram&) {
  }
}

/// What further methods say of a record, one after the other in the order of the index; nothing of a loop
/// that they were not asked about.
using Answers = std::function<std::vector<AssessmentRecord>(const ExperimentRecord&)>;

/// The answers in records of the same experiments, or of some of them.
Answers answers_in(const RecordRange& assessed) {
  RecordRange::Next next = assessed.one_by_one();
  const ExperimentRecord* const first = next();
  return [next = std::move(next), at = first](const ExperimentRecord& record) mutable {
    while (at != nullptr && (at->draw.index < record.draw.index || at->assessments.empty()))
      at = next();
    return at != nullptr && at->draw.index == record.draw.index ? at->assessments
                                                                : std::vector<AssessmentRecord>();
  };
}

/// Puts the answers of further methods behind those of the campaign, in the place of those that it has of
/// them; `begin` gives them for one way through its records.
void append(Campaign& campaign, const AssessmentForms& forms, const std::function<Answers()>& begin,
            const std::string& command) {
  const std::vector<std::size_t> others = places_of_others(campaign, forms);
  campaign.methods = chosen(campaign.methods, others);
  for (const auto& form : forms)
    campaign.methods.push_back({form, mpmbench_version(), source_revision(), command});
  change_records(campaign, [forms, others, begin]() -> RecordChange {
    return [forms, others, answers = begin()](ExperimentRecord& record) {
      std::vector<AssessmentRecord> further = answers(record);
      if (further.empty())
        further = unassessed(forms);
      record.assessments = chosen(record.assessments, others);
      std::move(further.begin(), further.end(), std::back_inserter(record.assessments));
    };
  });
  for (CalibrationLoop& loop : campaign.calibration.loops)
    loop.scores = chosen(loop.scores, others);
}

}  // namespace

std::int64_t compared_loops(const Campaign& campaign, const std::optional<std::int64_t>& experiments) {
  std::int64_t count = 0;
  records_of(campaign).each(
      [&](const ExperimentRecord& record) { count += is_compared(record, experiments) ? 1 : 0; });
  return count;
}

std::vector<std::string> missing_methods(const Campaign& campaign, const std::vector<std::string>& asked,
                                         const std::optional<std::int64_t>& experiments) {
  const std::vector<std::string> names = method_names(campaign);
  std::vector<bool> whole(names.size(), true);
  records_of(campaign).each([&](const ExperimentRecord& record) {
    for (std::size_t place = 0; place < names.size() && is_compared(record, experiments); ++place)
      if (record.assessments[place].status == AssessmentStatus::not_assessed)
        whole[place] = false;
  });
  std::vector<std::string> missing;
  for (const std::string& method : asked)
    if (const auto place =
            static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin());
        place == names.size() || !whole[place])
      missing.push_back(method);
  return missing;
}

std::vector<CampaignMethod> methods_of(const Study& study, const std::string& command) {
  std::vector<CampaignMethod> methods;
  for (auto& form : assessment_forms(study, study_methods(study)))
    methods.push_back({std::move(form), mpmbench_version(), source_revision(), command});
  return methods;
}

namespace {

/// Methods that assess the loops of a study in threads, by what they have learnt in the campaign: by the
/// active-set method, and one loop at a time by the solver of the campaign where that is Ipopt, whose linear
/// solver does not bear two threads.
class ThreadedRunners {
 public:
  ThreadedRunners(const Campaign& campaign, const Study& study, const std::vector<std::string>& methods,
                  int threads)
      : solver_(campaign.info.solver), by_campaign_solver_(runner_of(campaign, study, methods, solver_)) {
    for (int thread = 0; thread < threads; ++thread)
      by_active_set_.push_back(runner_of(campaign, study, methods, "active-set"));
  }

  const AssessmentForms& forms() const { return by_campaign_solver_->forms(); }

  /// What they say of an experiment that was run.
  std::vector<AssessmentRecord> assess(const ExperimentRecord& record, std::size_t thread) {
    return with_runner(record, thread, [&](ExperimentRunner& runner) { return runner.assess(record); });
  }

  /// What they see of it.
  AssessedLoop loop_of(const ExperimentRecord& record, std::size_t thread) {
    return with_runner(record, thread, [&](ExperimentRunner& runner) { return runner.loop_of(record); });
  }

  /// An experiment, run as a campaign runs it.
  ExperimentRecord run(std::int64_t index, std::size_t thread, StorePolicy store = StorePolicy::none) {
    if (solver_ != "ipopt") {
      ExperimentRecord record = by_active_set_[thread]->run(index, store);
      if (solver_ == "active-set" || !needs_ipopt(record))
        return record;
    }
    const std::lock_guard alone(ipopt_);
    return by_campaign_solver_->run(index, store);
  }

 private:
  using Runner = std::unique_ptr<ExperimentRunner>;

  /// Calls `work` with the runner by which this experiment is assessed.
  template <class Work>
  std::invoke_result_t<Work, ExperimentRunner&> with_runner(const ExperimentRecord& record,
                                                            std::size_t thread, Work work) {
    const bool needs_ipopt = solver_ == "ipopt" || record.solver.fallbacks > 0;
    if (!needs_ipopt || !by_campaign_solver_->runs_loops(record))
      return work(*by_active_set_[thread]);
    const std::lock_guard alone(ipopt_);
    return work(*by_campaign_solver_);
  }

  static Runner runner_of(const Campaign& campaign, const Study& study,
                          const std::vector<std::string>& methods, const std::string& solver) {
    return std::make_unique<ExperimentRunner>(
        study, assessment_context(campaign.study, campaign.basis, qp_solver_factory(solver)), methods);
  }

  std::string solver_;
  Runner by_campaign_solver_;
  std::vector<Runner> by_active_set_;
  std::mutex ipopt_;  // no critical region: an exception must not leave one
};

/// Has an execution give out loops that it makes itself: `make(index, thread)` returns the record of each.
template <class Make>
Execution execution_by(Make make) {
  return [make](const ExecutionPlan& plan, const StopRequest& stop, const OutcomeSink& deliver) {
    std::mutex delivery;
    for_each_in_threads(plan.indices.size(), plan.options.jobs, [&](std::size_t i, std::size_t thread) {
      if (requested(stop))
        return;
      ExperimentOutcome outcome;
      outcome.record = make(plan.indices[i], thread);
      const std::lock_guard one_at_a_time(delivery);
      deliver(std::move(outcome));
    });
  };
}

/// The study of an archive, as the further methods have it.
Study study_with(Study study, const std::vector<std::string>& methods) {
  study.methods = methods;
  return study;
}

RunOptions run_options(const Campaign& campaign, const ComparisonOptions& options) {
  RunOptions run{.solver = campaign.info.solver,
                 .audit_share = 0.0,
                 .store = StorePolicy::none,
                 .jobs = std::max(1, options.jobs)};
  if (options.kept) {
    run.archive = options.kept->archive;
    run.leftovers = options.kept->leftovers;
    run.shard_interval = options.kept->interval;
  }
  return run;
}

/// Records for threads, each of which asks for the next one or one soon after it: they are read one after the
/// other, and in memory are those that others will ask for in a moment.
class RecordsInTurn {
 public:
  /// Those with these indices, in ascending order, which there are and which must outlive it.
  RecordsInTurn(const RecordRange& records, const std::vector<std::int64_t>& indices)
      : next_(records.one_by_one()), wanted_(indices.begin()) {}

  /// Each once.
  ExperimentRecord take(std::int64_t index) {
    const std::lock_guard one_at_a_time(mutex_);
    while (read_.count(index) == 0) {
      const ExperimentRecord& record = *next_();
      if (record.draw.index == *wanted_)
        read_.emplace(*wanted_++, record);
    }
    return std::move(read_.extract(index).mapped());
  }

 private:
  RecordRange::Next next_;
  std::vector<std::int64_t>::const_iterator wanted_;
  std::map<std::int64_t, ExperimentRecord> read_;
  std::mutex mutex_;
};

/// The numbers of blind loops in the order in which they are made: that of the records, and then the
/// calibration loops.
std::vector<std::size_t> numbers_in_turn(const std::vector<BlindLoop>& order) {
  std::vector<std::size_t> numbers(order.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  std::sort(numbers.begin(), numbers.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(order[a].of_calibration, order[a].place) <
           std::tie(order[b].of_calibration, order[b].place);
  });
  return numbers;
}

/// Opens the experiments of a comparison, or its calibration loops.
void open(std::optional<ExperimentSeries>& series, const Study& study, const RunOptions& run,
          const WantedLoops& wanted, const std::optional<KeptAssessments>& kept, bool calibration) {
  if (!kept) {
    series.emplace(study, run, wanted, std::nullopt, ShardStore::Warn());
    return;
  }
  const auto folder = [&](const std::filesystem::path& shards) {
    return calibration ? calibration_shard_folder(shards) : shards;
  };
  std::vector<std::filesystem::path> others;
  for (const std::filesystem::path& part : kept->parts)
    for (std::filesystem::path& shard : shards_in(folder(part)))
      others.push_back(std::move(shard));
  series.emplace(study, run, wanted, folder(kept->shards), kept->warn, others);
}

}  // namespace

Comparison::Comparison(const Campaign& campaign, const ComparisonOptions& options)
    : campaign_(campaign),
      study_(study_with(campaign.study, options.methods)),
      run_(run_options(campaign, options)) {
  std::size_t place = 0;  // of a loop among those of the comparison
  std::vector<std::int64_t> wanted, calibrating;
  std::int64_t experiments = 0;
  records_of(campaign).each([&](const ExperimentRecord& record) {
    experiments = record.draw.index + 1;
    if (is_compared(record, options.experiments) && is_in_shard(place++, options.shard))
      wanted.push_back(record.draw.index);
  });
  open(loops_, study_, run_, {experiments, std::move(wanted)}, options.kept, false);
  const std::int64_t loops = std::ssize(campaign.calibration.loops);
  if (loops == 0)
    return;
  for (std::int64_t index = 0; index < loops; ++index)
    if (is_in_shard(place++, options.shard))
      calibrating.push_back(index);
  calibration_study_ = calibration_study(study_);
  open(calibration_, calibration_study_, calibration_options(run_), {loops, std::move(calibrating)},
       options.kept, true);
}

ExperimentTally Comparison::tally() const {
  ExperimentTally tally = loops_->tally();
  if (calibration_)
    tally += calibration_->tally();
  return tally;
}

void Comparison::run(const CampaignHooks& hooks) {
  ExperimentTally tally = this->tally();
  if (hooks.on_start)
    hooks.on_start(tally.done, tally.count);
  prepare_plant(campaign_.study);
  ThreadedRunners runners(campaign_, study_, study_.methods, run_.jobs);
  const Execution assess = [&](const ExecutionPlan& plan, const StopRequest& stop,
                               const OutcomeSink& deliver) {
    RecordsInTurn records(records_of(campaign_), plan.indices);
    execution_by([&](std::int64_t index, std::size_t thread) {
      ExperimentRecord record = records.take(index);
      record.assessments = runners.assess(record, thread);
      record.loop.reset();  // the archive has them
      record.truth.reset();
      return record;
    })(plan, stop, deliver);
  };
  loops_->run(campaign_.study, campaign_.basis, assess, hooks, tally);
  if (!calibration_)
    return;
  ThreadedRunners calibrating(campaign_, calibration_study_, study_.methods, run_.jobs);
  calibration_->run(
      campaign_.study, campaign_.basis,
      execution_by([&](std::int64_t index, std::size_t thread) { return calibrating.run(index, thread); }),
      hooks, tally);
}

void Comparison::compact() {
  loops_->compact();
  if (calibration_)
    calibration_->compact();
}

void Comparison::add_to(Campaign& campaign, const std::string& command, const StopRequest& stop) {
  append(
      campaign, assessment_forms(study_, study_.methods),
      [assessed = loops_->records(stop)] { return answers_in(assessed); }, command);
  if (!calibration_)
    return;
  const Calibration scored = calibration_of(calibration_study_, calibration_->records(stop));
  for (std::size_t i = 0; i < scored.loops.size(); ++i) {
    std::vector<double>& scores = campaign.calibration.loops[i].scores;
    scores.insert(scores.end(), scored.loops[i].scores.begin(), scored.loops[i].scores.end());
  }
}

void each_loop(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
               const std::function<void(std::size_t, const AssessedLoop&)>& take) {
  const int threads = std::max(1, jobs);
  prepare_plant(campaign.study);
  ThreadedRunners runners(campaign, campaign.study, {}, threads);
  const Study calibration = campaign.study.calibration ? calibration_study(campaign.study) : campaign.study;
  ThreadedRunners calibrating(campaign, calibration, {}, threads);
  const std::vector<std::size_t> numbers = numbers_in_turn(order);
  std::vector<std::int64_t> indices;
  for (const std::size_t number : numbers)
    if (!order[number].of_calibration)
      indices.push_back(order[number].index);
  RecordsInTurn records(records_of(campaign), indices);
  const auto make = [&](const BlindLoop& loop, std::size_t thread) {
    if (!loop.of_calibration)
      return runners.loop_of(records.take(loop.index), thread);
    const ExperimentRecord record = calibrating.run(loop.index, thread, StorePolicy::all);
    return record.status == ExperimentStatus::ok ? calibrating.loop_of(record, thread) : AssessedLoop();
  };
  std::mutex taking;
  for_each_in_threads(numbers.size(), threads, [&](std::size_t i, std::size_t thread) {
    const AssessedLoop loop = make(order[numbers[i]], thread);
    const std::lock_guard one_at_a_time(taking);
    take(numbers[i], loop);
  });
}

void add_verdicts(Campaign& campaign, OutsideVerdicts verdicts, const std::string& command) {
  const auto answers = std::make_shared<const std::vector<AssessmentRecord>>(std::move(verdicts.answers));
  append(
      campaign, {verdicts.form},
      [answers]() -> Answers {
        return [answers, place = std::size_t{0}](const ExperimentRecord&) mutable {
          return std::vector<AssessmentRecord>{(*answers)[place++]};
        };
      },
      command);
  for (std::size_t i = 0; i < campaign.calibration.loops.size(); ++i)
    campaign.calibration.loops[i].scores.push_back(verdicts.calibration_scores[i]);
}

Campaign with_methods(Campaign campaign, const std::vector<std::string>& methods,
                      const std::optional<std::int64_t>& experiments) {
  const std::vector<std::string> names = method_names(campaign);
  std::vector<std::size_t> places;
  for (const std::string& method : methods)
    places.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin()));
  campaign.methods = chosen(campaign.methods, places);
  RecordChange choose = [places, experiments, forms = forms_of(campaign)](ExperimentRecord& record) {
    record.assessments = experiments && record.draw.index >= *experiments
                             ? unassessed(forms)
                             : chosen(record.assessments, places);
  };
  change_records(campaign, [choose] { return choose; });
  for (CalibrationLoop& loop : campaign.calibration.loops)
    loop.scores = chosen(loop.scores, places);
  return campaign;
}

}  // namespace mpm
