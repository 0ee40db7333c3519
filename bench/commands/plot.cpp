#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/experiment_loop.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/text/experiment_heading.hpp"

namespace mpm {
namespace {

struct PlotArguments {
  std::string archive;
  std::int64_t index = 0;
  std::string output;  ///< its extension names the format
};

ExitCode plot(const PlotArguments& options) {
  const FigureFormat format = figure_format_of(options.output);
  require_no_input("--output", options.output, {options.archive});
  require_output_folder(options.output, "figure");
  const Campaign campaign = stream_input(options.archive);
  const ExperimentRecord record = experiment_of(campaign, options.index);
  const LoopRecord loop = loop_of(campaign, record);
  if (loop.trajectory.samples_done == 0)
    throw InputError(
        "INDEX",
        fmt::format("{}, whose closed loop has no samples ({})", options.index, to_string(record.status)),
        "an experiment that ran");
  Figure figure =
      trajectory_figure(campaign.study, loop.trajectory, nominal_of(campaign, record, loop), "experiment");
  for (const std::string& line : experiment_heading(campaign.study, record))
    figure.heading.push_back(as_label(line));
  write_text(options.output, draw_figure(figure, format));
  return ExitCode::done;
}

}  // namespace

void add_plot(CommandSet& commands) {
  const auto options = std::make_shared<PlotArguments>();
  CLI::App& app =
      commands.add("plot", "Draw the closed loop of one experiment", [options] { return plot(*options); });
  add_archive(app, options->archive);
  add_trust(app);
  add_index(app, options->index);
  add_path(app, "-o,--output", options->output, "Figure to write: NAME.svg, NAME.pdf or NAME.png")
      ->required();
}

}  // namespace mpm
