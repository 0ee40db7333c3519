#include "bench/command_plot.hpp"

#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/own_basis.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"
#include "bench/files.hpp"
#include "plants/error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/plot/plot_text.hpp"
#include "results/plot/trajectory_figure.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// The loop that was diagnosed: the one in the archive, or the same once more.
LoopRecord loop_of(const Campaign& campaign, const ExperimentRecord& record) {
  if (record.loop)
    return *record.loop;
  ExperimentRunner runner(campaign.study, campaign.basis, qp_solver_factory(campaign.info.solver));
  return std::move(*runner.run(record.draw.index, StorePolicy::all).loop);
}

/// y0 of the loop, from the S0 by which it was diagnosed. A loop without one of its own gets that of the
/// study.
NominalOutputs nominal_of(const Campaign& campaign, const ExperimentRecord& record, const LoopRecord& loop) {
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  const std::optional<OwnBasis> own = own_basis(campaign.study, record.draw, factory);
  const bool takes_own = own && own->basis.trajectory.status == ControlStatus::ok;
  const Study& study = takes_own ? own->study : campaign.study;
  const BasisCase& basis = takes_own ? own->basis : campaign.basis;
  return NominalEstimator(study, basis.point, basis.sensitivity, factory).estimate(loop.trajectory);
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
      trajectory_figure(campaign.study, loop.trajectory, nominal_of(campaign, record, loop), "experiment");
  for (const std::string& line : experiment_heading(campaign.study, record))
    figure.heading.push_back(as_label(line));
  const std::string drawing = draw_figure(figure, format);
  write_file_atomically(command.output, std::as_bytes(std::span(drawing)));
  return ExitCode::done;
}

}  // namespace mpm
