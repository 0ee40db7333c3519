#include "bench/campaign/comparison_runner.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <type_traits>

#include "analysis/methods/method_table.hpp"
#include "bench/execution/experiment_execution.hpp"
#include "bench/execution/thread_loop.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "scenarios/calibration.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {
namespace {

using Records = std::vector<ExperimentRecord*>;

bool is_compared(const ExperimentRecord& record, const std::optional<std::int64_t>& experiments) {
  return record.status == ExperimentStatus::ok && (!experiments || record.draw.index < *experiments);
}

Records compared_records(Campaign& campaign, const std::optional<std::int64_t>& experiments) {
  Records records;
  for (ExperimentRecord& record : campaign.records) {
    if (is_compared(record, experiments))
      records.push_back(&record);
  }
  return records;
}

void remove(Campaign& campaign, const std::string& method) {
  const std::vector<std::string> names = method_names(campaign);
  const auto place = std::find(names.begin(), names.end(), method) - names.begin();
  if (place == std::ssize(names))
    return;
  campaign.methods.erase(campaign.methods.begin() + place);
  for (ExperimentRecord& record : campaign.records)
    record.assessments.erase(record.assessments.begin() + place);
  for (CalibrationLoop& loop : campaign.calibration.loops)
    loop.scores.erase(loop.scores.begin() + place);
}

/// Where somebody else simulates the plant, its processes have to be prepared before threads are at work. Its
/// file may be gone: that matters to the loops that are run again, which then say so.
void prepare_plant(const Study& study) {
  if (!study.nonlinear || !study.nonlinear->model.foreign)
    return;
  try {
    study.nonlinear->model.foreign->load();
  } catch (const InputError&) {
  }
}

/// Puts the answers of further methods behind those of the campaign.
void append(Campaign& campaign, const AssessmentForms& forms, const Records& records,
            std::vector<std::vector<AssessmentRecord>> assessments, const std::string& command) {
  for (const auto& form : forms) {
    remove(campaign, form->method().name);
    campaign.methods.push_back({form, mpmbench_version(), source_revision(), command});
    for (ExperimentRecord& record : campaign.records)
      record.assessments.push_back(unassessed({form}).front());
  }
  for (std::size_t i = 0; i < records.size(); ++i)
    std::move(assessments[i].begin(), assessments[i].end(),
              records[i]->assessments.end() - static_cast<std::ptrdiff_t>(forms.size()));
}

}  // namespace

std::int64_t compared_loops(const Campaign& campaign, const std::optional<std::int64_t>& experiments) {
  return std::count_if(campaign.records.begin(), campaign.records.end(),
                       [&](const ExperimentRecord& record) { return is_compared(record, experiments); });
}

bool has_answers(const Campaign& campaign, const std::string& method,
                 const std::optional<std::int64_t>& experiments) {
  const std::vector<std::string> names = method_names(campaign);
  const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin());
  return place < names.size() &&
         std::none_of(campaign.records.begin(), campaign.records.end(), [&](const ExperimentRecord& record) {
           return is_compared(record, experiments) &&
                  record.assessments[place].status == AssessmentStatus::not_assessed;
         });
}

std::vector<CampaignMethod> methods_of(const Study& study, const std::string& command) {
  std::vector<CampaignMethod> methods;
  for (auto& form : assessment_forms(study, study_methods(study)))
    methods.push_back({std::move(form), mpmbench_version(), source_revision(), command});
  return methods;
}

namespace {

/// Methods that assess the loops of a study in threads: by the active-set method, and one loop at a time by
/// the solver of the campaign where that is Ipopt, whose linear solver does not bear two threads.
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
    return std::make_unique<ExperimentRunner>(study, campaign.basis, methods, qp_solver_factory(solver));
  }

  std::string solver_;
  Runner by_campaign_solver_;
  std::vector<Runner> by_active_set_;
  std::mutex ipopt_;  // no critical region: an exception must not leave one
};

/// Calls on_done, one call at a time.
class DoneReports {
 public:
  explicit DoneReports(const std::function<void()>& on_done) : on_done_(on_done) {}
  void one_more() {
    const std::lock_guard one_at_a_time(mutex_);
    if (on_done_)
      on_done_();
  }

 private:
  const std::function<void()>& on_done_;
  std::mutex mutex_;
};

/// Runs the calibration loops again, for the scores of the methods behind those that the campaign has.
void add_calibration(Campaign& campaign, const ComparisonOptions& options, int threads, DoneReports& done) {
  const Study loops = calibration_study(campaign.study);
  ThreadedRunners runners(campaign, loops, options.methods, threads);
  std::vector<ExperimentRecord> records(campaign.calibration.loops.size());
  for_each_in_threads(records.size(), threads, [&](std::size_t i, std::size_t thread) {
    records[i] = runners.run(static_cast<std::int64_t>(i), thread);
    done.one_more();
  });
  const Calibration added = calibration_of(loops, records);
  for (std::size_t i = 0; i < records.size(); ++i) {
    std::vector<double>& scores = campaign.calibration.loops[i].scores;
    scores.insert(scores.end(), added.loops[i].scores.begin(), added.loops[i].scores.end());
  }
}

}  // namespace

void add_methods(Campaign& campaign, const ComparisonOptions& options, const std::string& command) {
  const Records records = compared_records(campaign, options.experiments);
  const int threads = std::max(1, options.jobs);
  prepare_plant(campaign.study);
  ThreadedRunners runners(campaign, campaign.study, options.methods, threads);
  std::vector<std::vector<AssessmentRecord>> assessments(records.size());
  DoneReports done(options.on_done);
  for_each_in_threads(records.size(), threads, [&](std::size_t i, std::size_t thread) {
    assessments[i] = runners.assess(*records[i], thread);
    done.one_more();
  });
  append(campaign, runners.forms(), records, std::move(assessments), command);
  if (campaign.study.calibration)
    add_calibration(campaign, options, threads, done);
}

std::vector<AssessedLoop> loops_of(const Campaign& campaign, const std::vector<BlindLoop>& order, int jobs,
                                   const std::function<void()>& on_done) {
  const int threads = std::max(1, jobs);
  prepare_plant(campaign.study);
  ThreadedRunners runners(campaign, campaign.study, {}, threads);
  const Study calibration = campaign.study.calibration ? calibration_study(campaign.study) : campaign.study;
  ThreadedRunners calibrating(campaign, calibration, {}, threads);
  std::vector<AssessedLoop> loops(order.size());
  DoneReports done(on_done);
  for_each_in_threads(order.size(), threads, [&](std::size_t i, std::size_t thread) {
    const std::size_t place = order[i].place;
    if (!order[i].of_calibration) {
      loops[i] = runners.loop_of(campaign.records[place], thread);
    } else if (const ExperimentRecord record =
                   calibrating.run(static_cast<std::int64_t>(place), thread, StorePolicy::all);
               record.status == ExperimentStatus::ok) {
      loops[i] = calibrating.loop_of(record, thread);
    }
    done.one_more();
  });
  return loops;
}

void add_verdicts(Campaign& campaign, const OutsideVerdicts& verdicts, const std::string& command) {
  append(campaign, {verdicts.form}, {}, {}, command);
  for (std::size_t i = 0; i < campaign.records.size(); ++i)
    campaign.records[i].assessments.back() = verdicts.answers[i];
  for (std::size_t i = 0; i < campaign.calibration.loops.size(); ++i)
    campaign.calibration.loops[i].scores.push_back(verdicts.calibration_scores[i]);
}

Campaign with_methods(Campaign campaign, const std::vector<std::string>& methods,
                      const std::optional<std::int64_t>& experiments) {
  const std::vector<std::string> names = method_names(campaign);
  std::vector<std::size_t> places;
  for (const std::string& method : methods)
    places.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), method) - names.begin()));
  const auto chosen = [&](const auto& all) {
    std::remove_cvref_t<decltype(all)> list;
    for (const std::size_t place : places)
      list.push_back(all[place]);
    return list;
  };
  campaign.methods = chosen(campaign.methods);
  for (ExperimentRecord& record : campaign.records) {
    if (experiments && record.draw.index >= *experiments)
      record.assessments = unassessed(forms_of(campaign));
    else
      record.assessments = chosen(record.assessments);
  }
  for (CalibrationLoop& loop : campaign.calibration.loops)
    loop.scores = chosen(loop.scores);
  return campaign;
}

}  // namespace mpm
