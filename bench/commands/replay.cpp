#include <memory>
#include <string>

#include <fmt/format.h>

#include "analysis/findings/study_aggregate.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/record_bytes.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

struct Options {
  std::string archive;
  std::int64_t index = 0;
};

ExitCode replay(const Options& options) {
  const Campaign campaign = read_input(options.archive);
  const ExperimentRecord& archived = experiment_of(campaign, options.index);

  // From (study, seed, index) alone: the basis case is made again too.
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  const BasisCase basis = run_basis_case(campaign.study, factory);
  ExperimentRecord again = ExperimentRunner(campaign.study, basis, factory)
                               .run(options.index, archived.loop ? StorePolicy::all : StorePolicy::none);
  const bool identical = to_bytes(archived) == to_bytes(again);
  fmt::print("experiment {}: {}, {}\n", options.index, to_string(again.draw.kind), to_string(again.status));
  if (again.draw.named)
    fmt::print("{}\n", experiment_line(campaign.study, again));
  else if (again.status == ExperimentStatus::ok)
    fmt::print("located CV {} (true {}), I_MPM {:.4f}: {}\n",
               cv_name(campaign.study, again.diagnosis.predicted_cv),
               cv_name(campaign.study, again.draw.true_cv()), again.diagnosis.indicator.i_mpm,
               to_string(again.diagnosis.predicted_source));
  fmt::print("{}\n", identical ? "bit-identical to the archive" : "DIFFERS from the archive");
  return identical ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_replay(CommandSet& commands) {
  const auto options = std::make_shared<Options>();
  CLI::App& app =
      commands.add("replay", "Run one experiment of an archive again and say whether it is bit-identical",
                   [options] { return replay(*options); });
  add_archive(app, options->archive);
  add_index(app, options->index);
}

}  // namespace mpm
