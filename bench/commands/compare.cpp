#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/methods/method_table.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/comparison_runner.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

struct Options {
  std::string archive;
  std::vector<std::string> methods = assessment_method_names();
  std::string output;  ///< archive with the comparison; none when empty
  std::optional<std::int64_t> experiments;
  int jobs = 1;
  bool json = false;
  bool quiet = false;
};

void require_each_once(const std::vector<std::string>& methods) {
  for (auto method = methods.begin(); method != methods.end(); ++method)
    if (std::find(methods.begin(), method, *method) != method)
      throw InputError("--methods", fmt::format("'{}' twice", *method), "each method once");
}

ExitCode compare(const Options& options, const std::string& command_line) {
  require_each_once(options.methods);
  Campaign campaign = read_input(options.archive);
  if (!options.output.empty())
    require_output_folder(options.output, "archive");
  const std::int64_t loops = compared_loops(campaign, options.experiments);
  if (loops == 0)
    throw InputError(options.archive, "no loop that ran to its end", "one or more to compare methods on");
  Progress progress(options.quiet);
  progress.begin(loops);
  campaign.comparison = run_comparison(
      campaign,
      {.methods = options.methods, .experiments = options.experiments, .jobs = options.jobs, .on_done = [&] {
         progress.advance();
         progress.end_when_requested();
       }});
  if (!options.output.empty()) {
    campaign.comparison_info = {mpmbench_version(), source_revision(), command_line};
    write_archive(options.output, campaign);
  }
  fmt::print("{}", options.json ? comparison_json(campaign) : comparison_text(campaign));
  return ExitCode::done;
}

}  // namespace

void add_compare(CommandSet& commands) {
  const auto options = std::make_shared<Options>();
  CLI::App& app =
      commands.add("compare", "Assess the loops of an archive by several methods: how often is each right?",
                   [options, &commands] { return compare(*options, commands.command_line()); });
  add_archive(app, options->archive);
  app.add_option("--methods", options->methods, "Methods, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(assessment_method_names()))
      ->capture_default_str();
  app.add_option("-o,--output", options->output,
                 "Archive to write with the comparison in it (HDF5); may be ARCHIVE itself");
  add_experiments(app, options->experiments, "Compare on the first N experiments only");
  add_jobs(app, options->jobs, "How many loops are assessed at once");
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
