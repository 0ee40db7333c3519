#include "results/report/report.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/system/program_trust.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/experiment_loop.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "results/report/change_report.hpp"

namespace mpm {
namespace {

struct ReportArguments {
  std::vector<std::string> archives;  ///< one, or two for what changed from the first to the second
  std::string output;                 ///< empty: no page
  std::string figures;                ///< folder; empty: no figures as files
  std::string format = "svg";
};

/// The loops that the page draws. A loop that is not in the archive is simulated again. If that would start a
/// program that nobody has allowed, the page goes without the loop, and a note says so.
std::vector<LoopView> shown_loops(const Campaign& campaign) {
  std::vector<LoopView> views;
  std::string left_out;
  for (ShownExperiment& shown : loops_to_show(campaign))
    try {
      const ExperimentRecord& record = shown.record;
      LoopRecord loop = loop_of(campaign, record);
      NominalOutputs nominal = nominal_of(campaign, record, loop);
      views.push_back({std::move(shown), std::move(loop.trajectory), std::move(nominal)});
    } catch (const UntrustedProgram& error) {
      left_out = error.what();
    }
  if (!left_out.empty())
    print_note(fmt::format("mpmbench: loops are not drawn: {}\n", left_out));
  return views;
}

/// Writes two archives on one page.
ExitCode report_change(const ReportArguments& options) {
  if (options.archives.size() > 2)
    throw InputError("ARCHIVE", fmt::format("{} archives", options.archives.size()),
                     "one, or two for what changed from the first to the second");
  if (!options.figures.empty())
    throw InputError("--figures", "two archives", "one archive; two give a page, -o FILE");
  require_no_input("--output", options.output, options.archives);
  require_output_folder(options.output, "page");
  const Campaign before = stream_input(options.archives[0]);
  const Campaign now = stream_input(options.archives[1]);
  write_text(options.output, change_html(before, options.archives[0], now, options.archives[1]));
  print_result(fmt::format("{}\n", options.output));
  return ExitCode::done;
}

ExitCode report(const ReportArguments& options) {
  if (options.archives.size() > 1)
    return report_change(options);
  const std::string& archive = options.archives.front();
  const FigureFormat format = figure_format(options.format);
  if (!options.output.empty()) {
    require_no_input("--output", options.output, options.archives);
    require_output_folder(options.output, "page");
  }
  const Campaign campaign = stream_input(archive);
  const StudyFindings findings = findings_of(campaign);
  if (!options.output.empty()) {
    write_text(options.output, report_html(campaign, findings, archive, shown_loops(campaign)));
    print_result(fmt::format("{}\n", options.output));
  }
  if (!options.figures.empty())
    for (const std::filesystem::path& file : write_figures(campaign, findings, options.figures, format))
      print_result(fmt::format("{}\n", file.string()));
  return ExitCode::done;
}

}  // namespace

void add_report(CommandSet& commands) {
  const auto options = std::make_shared<ReportArguments>();
  CLI::App& app =
      commands.add("report", "Write the results of a study as one HTML page, and its figures as files",
                   [options] { return report(*options); });
  app.add_option("ARCHIVE", options->archives,
                 "Archive; with two, the page shows what changed from the first to the second")
      ->required()
      ->expected(1, -1);
  add_trust(app);
  CLI::Option_group* const outputs = app.add_option_group("outputs", "What to write, one or both");
  add_path(*outputs, "-o,--output", options->output, "Page to write (HTML)");
  CLI::Option* const figures =
      add_path(*outputs, "--figures", options->figures, "Folder to write the figures into, one file each");
  outputs->require_option(1, 2);
  app.add_option("--format", options->format, "Format of the figures")
      ->check(one_of(figure_format_names()))
      ->needs(figures)
      ->capture_default_str();
}

}  // namespace mpm
