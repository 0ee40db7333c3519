#include "bench/campaign/comparison_runner.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>

#include <omp.h>

#include "analysis/methods/method_table.hpp"
#include "bench/version.hpp"
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

/// Ipopt answered some problem of this experiment, when it did not run as a whole.
bool needs_ipopt(const Campaign& campaign, const ExperimentRecord& record) {
  return campaign.info.solver == "ipopt" || record.solver.fallbacks > 0;
}

void remove(Campaign& campaign, const std::string& method) {
  const std::vector<std::string> names = method_names(campaign);
  const auto place = std::find(names.begin(), names.end(), method) - names.begin();
  if (place == std::ssize(names))
    return;
  campaign.methods.erase(campaign.methods.begin() + place);
  for (ExperimentRecord& record : campaign.records)
    record.assessments.erase(record.assessments.begin() + place);
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

void add_methods(Campaign& campaign, const ComparisonOptions& options, const std::string& command) {
  const Records records = compared_records(campaign, options.experiments);
  const auto runner_of = [&](const std::string& solver) {
    return std::make_unique<ExperimentRunner>(campaign.study, campaign.basis, options.methods,
                                              qp_solver_factory(solver));
  };
  const int threads = std::max(1, options.jobs);
  std::vector<std::unique_ptr<ExperimentRunner>> runners;
  for (int thread = 0; thread < threads; ++thread)
    runners.push_back(runner_of("active-set"));
  const std::unique_ptr<ExperimentRunner> by_campaign_solver = runner_of(campaign.info.solver);
  std::vector<std::vector<AssessmentRecord>> assessments(records.size());
  std::vector<std::exception_ptr> failures(records.size());  // none may leave a thread
  std::atomic<std::size_t> first_failure{records.size()};    // only loops before it can still matter
  std::mutex ipopt, done;  // not critical regions: an exception must not leave one
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (i > first_failure)
      continue;
    try {
      if (by_campaign_solver->runs_loops(*records[i]) && needs_ipopt(campaign, *records[i])) {
        const std::lock_guard alone(ipopt);
        assessments[i] = by_campaign_solver->assess(*records[i]);
      } else {
        assessments[i] = runners[static_cast<std::size_t>(omp_get_thread_num())]->assess(*records[i]);
      }
      const std::lock_guard one_at_a_time(done);
      if (options.on_done)
        options.on_done();
    } catch (...) {
      failures[i] = std::current_exception();
      std::size_t first = first_failure;
      while (i < first && !first_failure.compare_exchange_weak(first, i)) {
      }
    }
  }
  if (first_failure < records.size())
    std::rethrow_exception(failures[first_failure]);
  append(campaign, by_campaign_solver->forms(), records, std::move(assessments), command);
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
  return campaign;
}

}  // namespace mpm
