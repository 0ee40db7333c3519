#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "results/plot/plot_text.hpp"
#include "results/report/html_table.hpp"
#include "results/report/report_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

/// Solver statistics of some experiments.
struct Effort {
  std::int64_t experiments = 0, steps = 0;
  std::vector<double> iterations_per_step;
  double largest_residual = NAN;
  std::int64_t worst = -1;  ///< experiment of the largest residual

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

void add_row(HtmlTable& table, const std::string& name, Effort effort) {
  if (effort.experiments == 0)
    return;
  std::sort(effort.iterations_per_step.begin(), effort.iterations_per_step.end());
  const auto& iterations = effort.iterations_per_step;
  table.row({name, fmt::format("{}", effort.experiments), fmt::format("{}", effort.steps),
             fmt::format("{:.1f}", sorted_quantile(iterations, 0.5)),
             fmt::format("{:.1f}", iterations.back()),
             std::isnan(effort.largest_residual) ? html_number(NAN)
                                                 : fmt::format("{:.1e}", effort.largest_residual),
             effort.worst < 0 ? html_number(NAN) : fmt::format("{}", effort.worst)});
}

/// What the solver `auto` adds: fallbacks, and the audit.
std::string audit_html(const SummaryContent& parts, const CampaignInfo& info) {
  const AuditSummary& audit = parts.audit;
  const std::string fallbacks = fmt::format(
      "<p>Ipopt answered <strong>{}</strong> problems in place of the active-set method, whose answer "
      "was not certified. ",
      parts.fallbacks);
  if (audit.steps == 0)
    return fallbacks + "No step was audited.</p>\n";
  HtmlTable table(
      fmt::format("Audit: a random share of {:g} of all steps, also solved by Ipopt.", info.audit_share),
      {{"Steps"},
       {"With another status"},
       {"Largest difference of a move"},
       {"Of a target"},
       {"Of an objective, relative"},
       {"Processor time, s"}});
  table.row({fmt::format("{}", audit.steps), fmt::format("{}", audit.disagreements),
             fmt::format("{:.1e}", audit.largest_move), fmt::format("{:.1e}", audit.largest_target),
             fmt::format("{:.1e}", audit.largest_objective), fmt::format("{:.1f}", info.audit_seconds)});
  return fallbacks + "An interior point is off by about 1e-6 at a limit that touches without pushing.</p>\n" +
         table.html();
}

}  // namespace

ReportSection solver_section(const ReportInput& input) {
  const Campaign& campaign = input.campaign;
  ReportSection section{"solver", "Solver", {}};
  HtmlTable table("Target and MPC problems of all closed loops; iterations and residuals cover both.",
                  {{"Kind", HtmlTable::Align::left},
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
    section.leave_out("the controller is a program: what it solves, and how well, is not known here.");
    return section;
  }
  section.add(
      fmt::format("<p>Every quadratic program was solved by <strong>{}</strong>. The KKT residual is "
                  "computed from the problem alone, whichever solver gave the answer.</p>\n",
                  html_text(campaign.info.solver)));
  section.add(table.html());
  if (campaign.info.solver == "auto")
    section.add(audit_html(input.parts, campaign.info));
  return section;
}

}  // namespace mpm
