#include "bench/comparison_runner.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>

#include <omp.h>

#include "analysis/basis/own_basis.hpp"
#include "solvers/qp_solver.hpp"

namespace mpm {
namespace {

using Records = std::vector<const ExperimentRecord*>;

Records compared_records(const Campaign& campaign, const std::optional<std::int64_t>& experiments) {
  Records records;
  for (const ExperimentRecord& record : campaign.records) {
    const bool wanted = !experiments || record.draw.index < *experiments;
    if (wanted && record.status == ExperimentStatus::ok)
      records.push_back(&record);
  }
  return records;
}

/// The loop was not stored, or its S0 has to be determined.
bool runs_loops(const Study& study, const ExperimentRecord& record) {
  return !record.loop || has_own_basis(study, record.draw);
}

/// Ipopt answered some problem of this experiment, when it did not run as a whole.
bool needs_ipopt(const Campaign& campaign, const ExperimentRecord& record) {
  return campaign.info.solver == "ipopt" || record.solver.fallbacks > 0;
}

}  // namespace

std::int64_t compared_loops(const Campaign& campaign, const std::optional<std::int64_t>& experiments) {
  return static_cast<std::int64_t>(compared_records(campaign, experiments).size());
}

Comparison run_comparison(const Campaign& campaign, const ComparisonOptions& options) {
  const Records records = compared_records(campaign, options.experiments);
  Comparison comparison;
  comparison.methods = options.methods;
  comparison.reasons.resize(options.methods.size());
  comparison.loops.resize(records.size());
  std::vector<std::vector<std::string>> reasons(records.size());

  const auto panel_of = [&](const std::string& solver) {
    return std::make_unique<MethodPanel>(campaign.study, campaign.basis, options.methods,
                                         qp_solver_factory(solver));
  };
  const auto assess = [&](MethodPanel& panel, std::size_t i) {
    comparison.loops[i] = panel.assess(*records[i], reasons[i]);
  };

  const int threads = std::max(1, options.jobs);
  std::vector<std::unique_ptr<MethodPanel>> panels;
  for (int thread = 0; thread < threads; ++thread)
    panels.push_back(panel_of("active-set"));
  const std::unique_ptr<MethodPanel> reference = panel_of(campaign.info.solver);
  std::vector<std::exception_ptr> failures(records.size());  // none may leave a thread
  std::atomic<std::size_t> first_failure{records.size()};    // only loops before it can still matter
  std::mutex ipopt, done;  // not critical regions: an exception must not leave one
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (i > first_failure)
      continue;
    try {
      if (runs_loops(campaign.study, *records[i]) && needs_ipopt(campaign, *records[i])) {
        const std::lock_guard alone(ipopt);
        assess(*reference, i);
      } else {
        assess(*panels[static_cast<std::size_t>(omp_get_thread_num())], i);
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
  for (const std::vector<std::string>& of_loop : reasons)
    for (std::size_t method = 0; method < of_loop.size(); ++method)
      if (comparison.reasons[method].empty())
        comparison.reasons[method] = of_loop[method];
  return comparison;
}

}  // namespace mpm
