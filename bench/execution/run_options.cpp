#include "bench/execution/run_options.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/study_findings.hpp"
#include "analysis/methods/method_table.hpp"
#include "base/error.hpp"

namespace mpm {

const std::vector<std::pair<std::string, StorePolicy>>& store_policies() {
  static const std::vector<std::pair<std::string, StorePolicy>> policies{{"none", StorePolicy::none},
                                                                         {"flagged", StorePolicy::flagged},
                                                                         {"all", StorePolicy::all},
                                                                         {"truth", StorePolicy::truth}};
  return policies;
}

const std::string& name_of(StorePolicy store) {
  const auto& policies = store_policies();
  return std::find_if(policies.begin(), policies.end(),
                      [&](const auto& policy) { return policy.second == store; })
      ->first;
}

StorePolicy store_policy(const std::string& name, const std::string& place) {
  for (const auto& [known, policy] : store_policies())
    if (known == name)
      return policy;
  std::vector<std::string> names;
  for (const auto& policy : store_policies())
    names.push_back(policy.first);
  throw InputError(place, name, fmt::format("{}", fmt::join(names, ", ")));
}

Study study_to_run(Study study, const RunOptions& options) {
  if (options.seed)
    study.seed = *options.seed;
  study.methods = options.methods.empty()
                      ? study_methods(study)
                      : method_table(study.assessment).known(options.methods, "--methods");
  check_reported(study);
  return study;
}

bool has_foreign_part(const Study& study) {
  return (study.nonlinear && study.nonlinear->model.foreign) || study.controller_program;
}

bool runs_in_threads(const Study& study, const RunOptions& options) {
  const bool safe = options.solver == "auto" || options.solver == "active-set";
  if (options.parallel == Parallel::threads && !safe)
    throw InputError("parallel", fmt::format("threads for the solver {}", options.solver),
                     "processes, or one of the solvers auto and active-set");
  return options.parallel == Parallel::by_solver ? safe && !has_foreign_part(study)
                                                 : options.parallel == Parallel::threads;
}

}  // namespace mpm
