#include "bench/campaign/comparison_runner.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <type_traits>
#include <utility>

#include "analysis/methods/method_messages.hpp"
#include "analysis/methods/method_table.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "plants/system/program_trust.hpp"
#include "results/files/byte_stream.hpp"
#include "scenarios/loop/calibration.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {
namespace {

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

ComparedLoops compared_loops(const Campaign& campaign, const std::vector<std::string>& asked,
                             const std::optional<std::int64_t>& experiments) {
  ComparedLoops loops;
  const std::vector<std::string> names = method_names(campaign);
  std::vector<bool> whole(names.size(), true);
  records_of(campaign).each([&](const ExperimentRecord& record) {
    loops.end = record.draw.index + 1;
    if (record.status != ExperimentStatus::ok || (experiments && record.draw.index >= *experiments))
      return;
    loops.experiments.push_back(record.draw.index);
    for (std::size_t place = 0; place < names.size(); ++place)
      if (record.assessments[place].status == AssessmentStatus::not_assessed)
        whole[place] = false;
  });
  for (const std::string& method : asked)
    if (const auto place =
            static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin());
        place == names.size() || !whole[place])
      loops.missing.push_back(method);
  return loops;
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

/// The study of an archive, as the further methods have it.
Study study_with(Study study, const std::vector<std::string>& methods) {
  study.methods = methods;
  return study;
}

RunOptions run_options(const Campaign& campaign, const ComparedLoops& loops,
                       const ComparisonOptions& options) {
  return {.experiments = loops.end,
          .solver = campaign.info.solver,
          .audit_share = 0.0,
          .store = StorePolicy::none,
          .archive = options.archive,
          .jobs = std::max(1, options.jobs),
          .leftovers = options.kept.leftovers,
          .shard_interval = options.kept.interval};
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
std::vector<std::int64_t> numbers_in_turn(const std::vector<BlindLoop>& order) {
  std::vector<std::int64_t> numbers(order.size());
  std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
  const auto turn = [&](std::int64_t number) {
    const BlindLoop& loop = order[static_cast<std::size_t>(number)];
    return std::pair(loop.of_calibration, loop.place);
  };
  std::sort(numbers.begin(), numbers.end(),
            [&](std::int64_t one, std::int64_t other) { return turn(one) < turn(other); });
  return numbers;
}

/// A loop as methods see it as bytes, and the reverse.
template <class Stream, class Loop>
void transfer_loop(Stream& stream, Loop& loop) {
  for (const LoopSignal& signal : loop_signals())
    transfer(stream, loop.*signal.member);
}

/// Has threads do `make(key, thread)`.
template <class Make>
LoopWork threaded_work(int jobs, const CampaignHooks& hooks, Make make) {
  const auto made = std::make_shared<std::size_t>(0);
  return {.jobs = jobs,
          .thread =
              [make, made] {
                return
                    [make, thread = (*made)++](std::int64_t key) -> LoopResult { return make(key, thread); };
              },
          .stop = hooks.stop,
          .on_start = hooks.on_start,
          .on_done = hooks.on_done};
}

}  // namespace

Comparison::Comparison(const Campaign& campaign, const ComparedLoops& loops, const ComparisonOptions& options)
    : campaign_(campaign),
      loops_(study_with(campaign.study, options.methods), run_options(campaign, loops, options)),
      store_(options.shards ? loops_.open(*options.shards, options.kept.warn) : loops_.in_memory()) {
  std::vector<std::int64_t> all = loops.experiments;
  for (std::int64_t index = 0; index < std::ssize(campaign.calibration.loops); ++index)
    all.push_back(kCalibrationKeys + index);
  for (std::size_t place = 0; place < all.size(); ++place)
    if (is_in_part(place, options.part))
      keys_.push_back(all[place]);
  for (const std::filesystem::path& part : options.parts)
    store_.take_stock(shards_in(part), options.kept.warn);
}

void Comparison::run(const CampaignHooks& hooks) {
  prepare_plant(campaign_.study);
  const std::vector<std::string>& methods = loops_.study().methods;
  const int jobs = loops_.options().jobs;
  ThreadedRunners runners(campaign_, loops_.study(), methods, jobs);
  std::optional<ThreadedRunners> calibrating;
  if (!campaign_.calibration.loops.empty())
    calibrating.emplace(campaign_, loops_.calibration(), methods, jobs);
  const std::vector<std::int64_t> missing = store_.missing(keys_);
  RecordsInTurn records(records_of(campaign_), missing);
  const auto assess = [&](std::int64_t key, std::size_t thread) {
    ExperimentOutcome outcome;
    if (key >= kCalibrationKeys) {
      outcome.record = calibrating->run(key - kCalibrationKeys, thread);
    } else {
      outcome.record = records.take(key);
      outcome.record.assessments = runners.assess(outcome.record, thread);
      outcome.record.loop.reset();  // the archive has them
      outcome.record.truth.reset();
    }
    return loops_.result(key, outcome);
  };
  run_missing(store_, keys_, threaded_work(jobs, hooks, assess));
}

void Comparison::add_to(Campaign& campaign, const std::string& command, const StopRequest& stop) {
  append(
      campaign, assessment_forms(loops_.study(), loops_.study().methods),
      [assessed = loops_.experiment_records(store_, stop)] { return answers_in(assessed); }, command);
  if (campaign.calibration.loops.empty())
    return;
  const Calibration scored = calibration_of(loops_.calibration(), loops_.calibration_records(store_, stop));
  for (std::size_t i = 0; i < scored.loops.size(); ++i) {
    std::vector<double>& scores = campaign.calibration.loops[i].scores;
    scores.insert(scores.end(), scored.loops[i].scores.begin(), scored.loops[i].scores.end());
  }
}

void run_blind_loops(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
                     const CampaignHooks& hooks, ShardStore& store) {
  const int threads = std::max(1, jobs);
  prepare_plant(campaign.study);
  ThreadedRunners runners(campaign, campaign.study, {}, threads);
  const Study calibration = campaign.study.calibration ? calibration_study(campaign.study) : campaign.study;
  ThreadedRunners calibrating(campaign, calibration, {}, threads);
  const std::vector<std::int64_t> numbers = store.missing(numbers_in_turn(order));
  std::vector<std::int64_t> indices;
  for (const std::int64_t number : numbers)
    if (const BlindLoop& loop = order[static_cast<std::size_t>(number)]; !loop.of_calibration)
      indices.push_back(loop.index);
  RecordsInTurn records(records_of(campaign), indices);
  const auto make = [&](std::int64_t number, std::size_t thread) {
    const BlindLoop& blind = order[static_cast<std::size_t>(number)];
    AssessedLoop loop;
    if (!blind.of_calibration) {
      loop = runners.loop_of(records.take(blind.index), thread);
    } else {
      const ExperimentRecord record = calibrating.run(blind.index, thread, StorePolicy::all);
      if (record.status == ExperimentStatus::ok)
        loop = calibrating.loop_of(record, thread);
    }
    ByteWriter writer;
    transfer_loop(writer, std::as_const(loop));
    return LoopResult{.bytes = writer.take()};
  };
  run_missing(store, numbers, threaded_work(threads, hooks, make));
}

BlindLoops blind_loops_in(const ShardStore& store, std::size_t count) {
  return {count, [&store, count]() -> BlindLoops::Next {
            return [next = store.in_order(0, static_cast<std::int64_t>(count))] {
              ByteReader reader(next()->bytes);
              AssessedLoop loop;
              transfer_loop(reader, loop);
              return loop;
            };
          }};
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
