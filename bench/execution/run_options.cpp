#include "bench/execution/run_options.hpp"

#include <algorithm>

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
  throw InputError(place, name, "none, flagged or all");
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

}  // namespace mpm
