#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/method_table.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/execution/experiment_work.hpp"
#include "bench/files/archive_input.hpp"
#include "results/archive/record_bytes.hpp"
#include "results/text/experiment_heading.hpp"
#include "results/text/experiment_text.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

struct ReplayArguments {
  std::string archive;
  std::int64_t index = 0;
};

/// The campaign without methods that this program does not have, such as verdicts from outside: it cannot ask
/// them again, and says so.
Campaign with_known_methods(Campaign campaign) {
  std::vector<std::string> kept, left_out;
  for (const std::string& method : method_names(campaign))
    (shipped_methods().has(method) ? kept : left_out).push_back(method);
  if (!left_out.empty())
    print_result(fmt::format("not asked again: {}\n", fmt::join(left_out, ", ")));
  return with_methods(std::move(campaign), kept, std::nullopt);
}

/// Runs an experiment as a campaign does: an exception makes a record `failed` with its text.
ExperimentRecord experiment_again(const Campaign& campaign, const BasisCase& basis,
                                  const QpSolverFactory& factory, std::int64_t index, StorePolicy store) {
  try {
    return ExperimentRunner(campaign.study, basis, method_names(campaign), factory).run(index, store);
  } catch (const std::exception& error) {
    ExperimentRecord lost = lost_record(campaign.study, index, error.what());
    lost.assessments = unassessed(forms_of(campaign));
    return lost;
  }
}

ExitCode replay(const ReplayArguments& options) {
  const Campaign campaign = with_known_methods(stream_input(options.archive));
  const ExperimentRecord archived = experiment_of(campaign, options.index);

  // All comes from (study, seed, index) alone: the basis case is run again too.
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  const BasisCase basis = run_basis_case(campaign.study, factory);
  const ExperimentRecord again = experiment_again(campaign, basis, factory, options.index,
                                                  archived.truth  ? StorePolicy::truth
                                                  : archived.loop ? StorePolicy::all
                                                                  : StorePolicy::none);
  const std::vector<std::string> differences =
      RecordBytes(campaign.study, forms_of(campaign)).differences(archived, again);
  print_result(fmt::format("experiment {}: {}, {}\n", options.index, to_string(again.draw.kind),
                           to_string(again.status)));
  print_result(fmt::format("{}\n", experiment_line(campaign.study, again)));
  if (const std::string conditions = conditions_text(again); !conditions.empty())
    print_result(conditions + "\n");
  if (differences.empty())
    print_result("bit-identical to the archive\n");
  else
    print_result(fmt::format("DIFFERS from the archive: {}\n", fmt::join(differences, ", ")));
  return differences.empty() ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_replay(CommandSet& commands) {
  const auto options = std::make_shared<ReplayArguments>();
  CLI::App& app =
      commands.add("replay", "Run one experiment of an archive again and say whether it is bit-identical",
                   [options] { return replay(*options); });
  add_archive(app, options->archive);
  add_trust(app);
  add_index(app, options->index);
}

}  // namespace mpm
