#include "results/report/report.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/experiment_loop.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"

namespace mpm {
namespace {

struct ReportArguments {
  std::string archive;
  std::string output;   ///< no page when empty
  std::string figures;  ///< folder; no figures as files when empty
  std::string format = "svg";
};

/// The loops that the page draws. What is not in the archive is simulated again, unless that would start
/// somebody's program.
std::vector<LoopView> shown_loops(const Campaign& campaign) {
  std::vector<LoopView> views;
  for (const std::int64_t index : loops_to_show(campaign)) {
    const ExperimentRecord& record = experiment_of(campaign, index);
    if (!record.loop && !campaign.info.outside_files.empty())
      continue;
    LoopRecord loop = loop_of(campaign, record);
    NominalOutputs nominal = nominal_of(campaign, record, loop);
    views.push_back({index, std::move(loop.trajectory), std::move(nominal)});
  }
  return views;
}

ExitCode report(const ReportArguments& options) {
  const FigureFormat format = figure_format(options.format);
  if (!options.output.empty())
    require_output_folder(options.output, "page");
  const Campaign campaign = read_input(options.archive);
  const StudyFindings findings = findings_of(campaign);
  if (!options.output.empty()) {
    write_text(options.output, report_html(campaign, findings, options.archive, shown_loops(campaign)));
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
      commands.add("report", "Write what a study found as one HTML page, and its figures as files",
                   [options] { return report(*options); });
  add_archive(app, options->archive);
  CLI::Option_group* const outputs = app.add_option_group("outputs", "What to write, one or both");
  add_path(*outputs, "-o,--output", options->output, "Page to write (HTML)");
  CLI::Option* const figures =
      add_path(*outputs, "--figures", options->figures, "Folder to write the figures into, one file each");
  outputs->require_option(1, 2);
  app.add_option("--format", options->format, "Format of these files")
      ->check(CLI::IsMember(figure_format_names()))
      ->needs(figures)
      ->capture_default_str();
}

}  // namespace mpm
