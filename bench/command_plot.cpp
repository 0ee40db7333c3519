#include "bench/command_plot.hpp"

#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/nominal_estimator.hpp"
#include "bench/files.hpp"
#include "plants/error.hpp"
#include "results/atomic_file.hpp"
#include "results/experiment_text.hpp"
#include "results/figure_drawing.hpp"
#include "results/plot_text.hpp"
#include "results/trajectory_figure.hpp"

namespace mpm {
namespace {

/// The loop that was diagnosed: the one in the archive, or the same once more.
LoopRecord loop_of(const Campaign& campaign, const ExperimentRecord& record) {
  if (record.loop)
    return *record.loop;
  ExperimentRunner runner(campaign.study, campaign.basis, qp_solver_factory(campaign.info.solver));
  return std::move(*runner.run(record.draw.index, StorePolicy::all).loop);
}

}  // namespace

ExitCode plot(const PlotCommand& command) {
  const FigureFormat format = figure_format_of(command.output);
  require_output_folder(command.output, "figure");
  const Campaign campaign = read_input(command.archive);
  const ExperimentRecord& record = experiment_of(campaign, command.index);
  const LoopRecord loop = loop_of(campaign, record);
  if (loop.trajectory.samples_done == 0)
    throw InputError(
        "INDEX",
        fmt::format("{}, whose closed loop has no samples ({})", command.index, to_string(record.status)),
        "an experiment that ran");
  Figure figure =
      trajectory_figure(campaign.study, loop.trajectory,
                        NominalEstimator(campaign.study, campaign.basis.point, campaign.basis.sensitivity,
                                         qp_solver_factory(campaign.info.solver))
                            .estimate(loop.trajectory),
                        "experiment");
  for (const std::string& line : experiment_heading(campaign.study, record))
    figure.heading.push_back(as_label(line));
  const std::string drawing = draw_figure(figure, format);
  write_file_atomically(command.output, std::as_bytes(std::span(drawing)));
  return ExitCode::done;
}

}  // namespace mpm
