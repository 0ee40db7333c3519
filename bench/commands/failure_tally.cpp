#include "bench/commands/failure_tally.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {

void FailureTally::add(const StudyFindings& findings) {
  for (const MethodFindings& method : findings.methods)
    add(method.name(), method.rates.failures);
}

void FailureTally::add(const std::string& method, const VerdictFailures& failures) {
  const auto found = std::find_if(methods_.begin(), methods_.end(),
                                  [&method](const auto& each) { return each.first == method; });
  if (found == methods_.end())
    methods_.emplace_back(method, failures);
  else
    found->second.add(failures);
}

void FailureTally::tell(Progress& progress) const {
  for (const auto& [method, failures] : methods_)
    if (failures.failed > 0)
      progress.warn(shown_text(fmt::format("method '{}' {}", method, failures_text(failures))));
}

}  // namespace mpm
