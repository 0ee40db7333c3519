#include "bench/execution/run_options.hpp"

#include "analysis/findings/study_findings.hpp"
#include "analysis/methods/method_table.hpp"

namespace mpm {

Study study_to_run(Study study, const RunOptions& options) {
  if (options.seed)
    study.seed = *options.seed;
  study.methods =
      options.methods.empty() ? study_methods(study) : known_methods(options.methods, "--methods");
  check_reported(study);
  return study;
}

}  // namespace mpm
