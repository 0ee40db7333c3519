#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/report_sections.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// Solver statistics of several experiments.
struct Effort {
  std::int64_t experiments = 0, steps = 0;
  std::vector<double> iterations_per_step;
  double largest_residual = NAN;
  std::int64_t worst = -1;  ///< experiment with the largest residual

  void add(const ExperimentRecord& record) {
    if (record.solver.steps <= 0)
      return;
    ++experiments;
    steps += record.solver.steps;
    iterations_per_step.push_back(static_cast<double>(record.solver.iterations) /
                                  static_cast<double>(record.solver.steps));
    const double residual = record.solver.largest_kkt_residual;
    if (std::isfinite(residual) && !(residual <= largest_residual)) {
      largest_residual = residual;
      worst = record.draw.index;
    }
  }
};

void add_row(Table& table, const std::string& name, Effort effort) {
  if (effort.experiments == 0)
    return;
  std::sort(effort.iterations_per_step.begin(), effort.iterations_per_step.end());
  const auto& iterations = effort.iterations_per_step;
  table.row({name, effort.experiments, effort.steps, fmt::format("{:.1f}", sorted_quantile(iterations, 0.5)),
             fmt::format("{:.1f}", iterations.back()),
             std::isnan(effort.largest_residual) ? "-" : fmt::format("{:.1e}", effort.largest_residual),
             effort.worst < 0 ? Cell("-") : Cell(effort.worst)});
}

}  // namespace

Section solver_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  Section section{"solver", "Solver", {}};
  Table table("Target and MPC problems of all closed loops; iterations and residuals cover both.",
              {{"Kind", Table::Align::left},
               {"Experiments"},
               {"Samples"},
               {"Iterations a sample, median"},
               {"Largest"},
               {"Largest KKT residual"},
               {"In experiment"}});
  Effort all;
  records_of(campaign).each([&all](const ExperimentRecord& record) { all.add(record); });
  if (all.experiments == 0) {
    section.leave_out("no experiment has solver statistics.");
    return section;
  }
  for (const KindFindings& kind : input.kinds()) {
    Effort effort;
    records_of(campaign).each([&](const ExperimentRecord& record) {
      if (record.draw.kind == kind.kind)
        effort.add(record);
    });
    add_row(table, kind_name(kind.kind), std::move(effort));
  }
  add_row(table, "all", std::move(all));
  if (campaign.study.controller_program) {
    section.leave_out("the controller is a program: what it solves, and how well, is unknown.");
    return section;
  }
  section.say(fmt::format(
      "Every quadratic program was solved by {}. The KKT residual is computed from the problem alone, "
      "whichever solver gave the answer.",
      strong(as_label(campaign.info.solver))));
  section.add(std::move(table));
  if (campaign.info.solver == "auto")
    section.say(audit_words(input.parts, campaign.info) +
                ". An interior-point solver is off by about 1e-6 at a limit that is touched with a "
                "multiplier of zero.");
  return section;
}

}  // namespace mpm
