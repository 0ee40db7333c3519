#include "bench/command_compare.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bench/comparison_runner.hpp"
#include "bench/files.hpp"
#include "bench/progress.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {

namespace {

void require_each_once(const std::vector<std::string>& methods) {
  for (auto method = methods.begin(); method != methods.end(); ++method)
    if (std::find(methods.begin(), method, *method) != method)
      throw InputError("--methods", fmt::format("'{}' twice", *method), "each method once");
}

}  // namespace

ExitCode compare(const CompareCommand& command, const std::string& command_line) {
  require_each_once(command.methods);
  Campaign campaign = read_input(command.archive);
  if (!command.output.empty())
    require_output_folder(command.output, "archive");
  const std::int64_t loops = compared_loops(campaign, command.experiments);
  if (loops == 0)
    throw InputError(command.archive, "no loop that ran to its end", "one or more to compare methods on");
  Progress progress(loops, command.quiet ? Progress::Mode::quiet : Progress::Mode::automatic);
  try {
    campaign.comparison = run_comparison(campaign, {.methods = command.methods,
                                                    .experiments = command.experiments,
                                                    .jobs = command.jobs,
                                                    .on_done = [&] { progress.advance(false); }});
    progress.finish();
  } catch (...) {
    progress.finish();
    throw;
  }
  if (!command.output.empty()) {
    campaign.comparison_info = {mpmbench_version(), source_revision(), command_line};
    write_archive(command.output, campaign);
  }
  fmt::print("{}", command.json ? comparison_json(campaign) : comparison_text(campaign));
  return ExitCode::done;
}

}  // namespace mpm
