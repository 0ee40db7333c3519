#include "results/summary/summary_sections.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/experiment/judgement.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "analysis/sensitivity/loop_interaction.hpp"
#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {

bool is_own(const StudyFindings& findings, const std::string& method) {
  return method.empty() || (findings.chain() != nullptr && findings.chain()->name() == method);
}

namespace {

/// Says where the interaction of the loops is strongest at the operating point, and how strong it is.
std::string interaction_words(const Study& study, const BasisCase& basis) {
  const LoopInteraction interaction = loop_interaction(study, basis.point, basis.sensitivity);
  if (interaction.frequency.size() == 0)
    return "no CV is at a setpoint or a soft limit";
  std::vector<std::string> gains;
  for (std::size_t i = 0; i < interaction.mvs.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    gains.push_back(fmt::format("{}-{} {:.3g}", cv_name(study, interaction.cvs[i]),
                                mv_name(study, interaction.mvs[i]),
                                interaction.relative_gain_at_maximum(at, at)));
  }
  return fmt::format("RPN (4.16) is largest at {:.3g} rad/{}, {:.3g}{}{}", interaction.rpn_frequency,
                     as_label(study.plant.time_unit), interaction.rpn_maximum,
                     gains.empty() ? "" : "; |RGA| there: ", listed(gains));
}

/// Says what kind of controller the study has.
std::string controller_words(const Study& study) {
  const MpcOptions& controller = study.controller;
  if (study.controller_program)
    return fmt::format("the program {}",
                       code(fmt::format("{}", fmt::join(study.controller_program->command(), " "))));
  const std::string holds =
      controller.has_setpoints()
          ? controller.has_soft_limits() ? "MPC with setpoints and ranges" : "setpoint MPC"
          : "range MPC";
  return holds + (controller.has_targets() ? " with target optimizer" : "");
}

bool is_in_table(const StudyFindings& findings, const Finding& row) {
  if (row.has_reported())
    return true;
  if (row.prominence == Prominence::detail || row.group == FindingGroup::dominance ||
      row.group == FindingGroup::method)
    return false;
  // A method that answers no loop, perhaps because there are no setpoints, has nothing to show.
  return is_own(findings, row.method) || findings.of(row.method)->rates["answered"].hits > 0;
}

std::string heading_of(const StudyFindings& findings, const Finding& row) {
  switch (row.group) {
    case FindingGroup::study:
      break;
    case FindingGroup::kind:
      return row.kind ? kind_heading(findings, *row.kind, row.method) : "Kinds together";
    case FindingGroup::dominance:
      return "I_{MPM} by dominance of the mismatch";
    case FindingGroup::s0:
      return "An error in S_{0}";
    case FindingGroup::faultless:
      return "Model and plant agree";
    case FindingGroup::method:
      return "Methods, over all loops: " + as_label(row.method);
  }
  return "All experiments";
}

/// What was wrong and, on a page, the command that runs the experiment again.
Cell fault_cell(const Study& study, const ExperimentDraw& draw, const std::string& file) {
  return Cell(as_label(fault_text(study, draw)))
      .with(code(fmt::format("mpmbench replay {} {}", file, draw.index)));
}

Table::Column fault_column() {
  return {"Fault, and how to replay it", Table::Align::text, Shown::page};
}

std::vector<Table::Column> with_cvs(std::vector<Table::Column> columns, const Study& study) {
  for (const PlantModel::Variable& cv : study.plant.cvs)
    columns.push_back({as_label(cv.name)});
  return columns;
}

/// What was found, marked if it is wrong.
Cell marked(const std::string& found, Correctness correctness) {
  return correctness == Correctness::right || correctness == Correctness::not_judged
             ? Cell(as_label(found))
             : Cell(as_label(found)).toned(Cell::Tone::bad);
}

Number of_cv(const AssessmentRecord& said, const char* name, Eigen::Index cv) {
  return {cv >= 0 ? said.number(name, cv) : kNaN, NumberForm::fixed};
}

}  // namespace

std::string identification_words(const Study& study, const BasisCase& basis) {
  const Eigen::VectorXd largest = largest_differences(basis.sensitivity, *basis.sensitivity_direct);
  std::vector<std::string> of_cvs;
  for (Eigen::Index a = 0; a < largest.size(); ++a)
    of_cvs.push_back(fmt::format(
        "{} {:.2g}", cv_name(study, basis.sensitivity.active[static_cast<std::size_t>(a)].cv), largest(a)));
  return "Box-Jenkins models; largest difference from the direct step responses: " + listed(of_cvs);
}

std::string audit_words(const SummaryContent& parts, const CampaignInfo& info) {
  const AuditSummary& audit = parts.audit;
  const std::string fallbacks = parts.fallbacks == 0
                                    ? "no problem fell back to Ipopt"
                                    : counted(parts.fallbacks, "problem") + " fell back to Ipopt";
  if (audit.steps == 0)
    return fallbacks + "; no step audited";
  return fmt::format(
      "{}; {} also solved by Ipopt: {} with another status, moves differ by at most {:.1e}, targets by "
      "{:.1e}, "
      "objectives by {:.1e}; {:.1f} s of processor time",
      fallbacks, counted(audit.steps, "step"), audit.disagreements, audit.largest_move, audit.largest_target,
      audit.largest_objective, info.audit_seconds);
}

std::string kind_heading(const StudyFindings& findings, ExperimentKind kind, const std::string& method) {
  return is_own(findings, method) ? kind_name(kind)
                                  : fmt::format("{}, {}", kind_name(kind), as_label(method));
}

std::string fixed_names(const Study& study) {
  std::vector<std::string> names;
  for (const Eigen::Index mv : study.s0_perturbation.fixed_mvs)
    names.push_back(mv_name(study, mv));
  return listed(names);
}

Facts run_facts(const Campaign& campaign, const SummaryContent& parts) {
  const Study& study = campaign.study;
  const PlantModel& plant = study.plant;
  const CampaignInfo& info = campaign.info;
  Facts facts;
  facts.add("study", as_label(fmt::format("{}: {}", study.name, study.title)));
  facts.add("plant", as_label(plant.name),
            fmt::format("{}, {}, {}", counted(std::ssize(plant.cvs), "CV"),
                        counted(std::ssize(plant.mvs), "MV"), counted(std::ssize(plant.mds), "MD")));
  facts.add("controller", controller_words(study),
            fmt::format("sample time {:g} {}, prediction horizon {}, control horizon {}",
                        study.controller.sample_time, as_label(plant.time_unit),
                        study.controller.prediction_horizon, study.controller.control_horizon));
  if (study.controller_program)
    facts.add("answers", "the controller is a program: its answers are neither certified nor audited");
  if (!campaign.basis.sensitivity.is_known)
    facts.add("S_{0}", "none: the program runs on the plant only, not on its own model");
  facts.add("experiments",
            fmt::format("{} ({}) of {} samples", parts.findings.experiments, kinds_text(study, parts.kinds),
                        study.simulation.samples),
            endings_text(study, parts.findings));
  facts.add("seed", fmt::to_string(study.seed));
  facts.add("program",
            as_label(fmt::format("mpmbench {} ({}), solver {}", info.mpmbench_version,
                                 info.git_sha.empty() ? "unknown revision" : info.git_sha, info.solver)));
  if (!info.outside_files.empty())
    facts.add("from outside", as_label(info.outside_files));
  facts.add("run", fmt::format("{}, {:.1f} s with {}", as_label(info.created), info.seconds,
                               counted(std::max(info.jobs, 0), "job")));
  if (info.solver == "auto" && !study.controller_program)
    facts.add("audit", audit_words(parts, info));
  if (campaign.basis.sensitivity_direct)
    facts.add("T_{0}", identification_words(study, campaign.basis));
  facts.add("interaction", interaction_words(study, campaign.basis));
  return facts;
}

Table findings_table(const Study& study, const StudyFindings& findings) {
  const bool any = std::any_of(findings.rows.begin(), findings.rows.end(),
                               [](const Finding& row) { return row.has_reported(); });
  Table table(
      fmt::format("Measured values with {:g} % intervals; {}", 100.0 * study.aggregate.confidence,
                  any ? "a number agrees with the reported one if its interval contains it. For shares, the "
                        "sampling error of the reported one counts too if its number of experiments is known."
                      : "the study names no values to compare with."),
      {{"name", Table::Align::left, Shown::text},
       {"Quantity", Table::Align::left, Shown::page},
       {"measured"},
       {"count"}});
  if (any)
    table.columns.insert(table.columns.end(), {{"reported"}, {"agree", Table::Align::left}});
  std::vector<std::pair<std::string, std::vector<const Finding*>>> groups;
  for (const Finding& row : findings.rows) {
    if (!is_in_table(findings, row))
      continue;
    const std::string heading = heading_of(findings, row);
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const auto& each) { return each.first == heading; });
    if (group == groups.end())
      group = groups.insert(group, {heading, {}});
    group->second.push_back(&row);
  }
  for (const auto& [heading, rows] : groups) {
    table.group(heading);
    for (const Finding* const row : rows) {
      const NumberForm form = row->is_share() ? NumberForm::share : NumberForm::fixed;
      const std::optional<bool> agrees = row->agrees(study.aggregate.confidence);
      table.row({as_label(row->name), row->label, Number{row->value, form, row->interval}, row->count,
                 Cell(Number{row->reported, form})
                     .with(row->reported_of > 0 ? fmt::format("of {}", row->reported_of) : ""),
                 !agrees   ? Cell("")
                 : *agrees ? Cell("yes").toned(Cell::Tone::good)
                           : Cell("no").toned(Cell::Tone::bad)});
    }
  }
  return table;
}

Table dominance_table(const Study& study, const std::vector<DominanceBin>& bins) {
  Table table("I_{MPM} by dominance of the mismatch.", {{"dominance", Table::Align::left},
                                                        {"mean"},
                                                        {"count"},
                                                        {fmt::format("above {:g}", mpm_threshold(study))}});
  for (const DominanceBin& bin : bins)
    table.row({fmt::format("{:g} to {:g}", bin.lower, bin.upper),
               fixed(bin.i_mpm.mean, bin.i_mpm.mean_interval), bin.i_mpm.count, number(bin.above_threshold)});
  return table;
}

Table wrong_table(const Study& study, const SummaryContent& parts, const std::string& file, std::size_t most,
                  const std::function<std::string(std::int64_t)>& number) {
  Table table(
      "Experiments with impact in which the CV, or the source of a single fault, is wrong. Ivar and "
      "Ivar_{diag} are those of the true CV, followed by Ivar_{diag} of the located one.",
      {{"No."},
       {"Kind", Table::Align::left},
       fault_column(),
       {"True CV", Table::Align::left},
       {"Located", Table::Align::left},
       {"Source", Table::Align::left},
       {"I_{MPM}"},
       {"Ivar"},
       {"Ivar_{diag}"},
       {"of located", Table::Align::right, Shown::page},
       {"Dominance", Table::Align::right, Shown::page},
       {"", Table::Align::text, Shown::text}});
  for (std::size_t i = 0; i < std::min(parts.wrong.size(), most); ++i) {
    const ExperimentRecord& record = *parts.wrong[i];
    const ExperimentDraw& draw = record.draw;
    const AssessmentRecord& verdict = record.chain();
    const Judgement judgement = judge(study, record, verdict);
    const bool faultless = is_faultless(draw.kind);
    table.row({number(draw.index), kind_name(draw.kind), fault_cell(study, draw, file),
               as_label(cv_name(study, draw.true_cv())),
               marked(cv_name(study, verdict.predicted_cv),
                      faultless ? Correctness::wrong : judgement.predicted_cv),
               marked(source_name(verdict.predicted_source),
                      faultless ? Correctness::wrong : judgement.predicted_source),
               fixed(verdict.number("i_mpm")), of_cv(verdict, "ivar", draw.true_cv()),
               of_cv(verdict, "ivar_diag", draw.true_cv()), of_cv(verdict, "ivar_diag", verdict.predicted_cv),
               fixed(verdict.number("dominance_mpm")),
               as_label(fmt::format("mpmbench replay {} {}", file, draw.index))});
  }
  return table;
}

Table failed_table(const Study& study, const SummaryContent& parts, const std::string& file,
                   std::size_t most) {
  Table table("Experiments that failed.",
              {{"No."}, {"Kind", Table::Align::left}, fault_column(), {"Why", Table::Align::text}});
  for (std::size_t i = 0; i < std::min(parts.failed.size(), most); ++i)
    table.row({parts.failed[i]->draw.index, kind_name(parts.failed[i]->draw.kind),
               fault_cell(study, parts.failed[i]->draw, file), as_label(parts.failed[i]->message)});
  return table;
}

Table scenario_table(const Campaign& campaign, const std::string& file) {
  const Study& study = campaign.study;
  const DiagnosisOptions& options = study.diagnosis;
  Table table(
      fmt::format(
          "Named scenarios, and the verdict on each CV compared with the study. Flagged: Ivar_{{diag}} "
          "outside {:g} to {:g}; source by I_{{MPM}} above or below {:g}.",
          options.impact_lower, options.impact_upper, mpm_threshold(study)),
      {{"scenario", Table::Align::left},
       {"What is wrong, and how to replay it", Table::Align::text, Shown::page},
       {"affected", Table::Align::left},
       {"flagged", Table::Align::left},
       {"TSSE"},
       {"verdict", Table::Align::text}});
  for (const ExperimentRecord& record : campaign.records) {
    const std::string& description = study.scenarios[static_cast<std::size_t>(record.draw.index)].description;
    const AssessmentRecord& said = record.chain();
    Cell fault = fault_cell(study, record.draw, file);
    if (!description.empty())
      fault.content = strong(as_label(description)) + ": " + std::get<std::string>(fault.content);
    table.row({as_label(scenario_name(study, record)), std::move(fault),
               as_label(affected_text(study, record.draw)), as_label(flagged_text(study, said)),
               Number{total_simulation_error(said)},
               Cell(as_label(scenario_verdict_text(study, record)))
                   .toned(!said.answered()                     ? Cell::Tone::plain
                          : judge(study, record, said).wrong() ? Cell::Tone::bad
                                                               : Cell::Tone::good)});
  }
  return table;
}

Table index_table(const Campaign& campaign) {
  const Study& study = campaign.study;
  Table table("Ivar and Ivar_{diag} of every CV; *: outside the band of impact.",
              with_cvs({{"scenario", Table::Align::left}, {"index", Table::Align::left}}, study));
  for (const ExperimentRecord& record : campaign.records)
    for (const auto& [name, heading] : {std::pair{"ivar", "Ivar"}, std::pair{"ivar_diag", "Ivar_{diag}"}}) {
      std::vector<Cell> cells{as_label(scenario_name(study, record)), heading};
      const Eigen::MatrixXd values = record.chain().values(name);
      for (const double value : values.reshaped()) {
        Cell cell = Number{value};
        if (study.diagnosis.has_impact(value)) {
          cell.mark = "*";
          cell.tone = Cell::Tone::bad;
        }
        cells.push_back(std::move(cell));
      }
      table.row(std::move(cells));
    }
  return table;
}

Table indicator_table(const Campaign& campaign) {
  const Study& study = campaign.study;
  Table table("Indicators of the flagged CVs.", {{"scenario", Table::Align::left},
                                                 {"CV", Table::Align::left},
                                                 {"I_{MPM}"},
                                                 {"co_{dkts}"},
                                                 {"co_{dskn}"},
                                                 {"SSE"}});
  for (const ExperimentRecord& record : campaign.records) {
    const AssessmentRecord& chain = record.chain();
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
      if (chain.flags(cv))
        table.row({as_label(scenario_name(study, record)), as_label(cv_name(study, cv)),
                   Number{chain.number("cv_i_mpm", cv)}, Number{chain.number("cv_co_dkts", cv)},
                   Number{chain.number("cv_co_dskn", cv)}, Number{chain.number("cv_sse", cv)}});
  }
  return table;
}

Table acf_table(const Campaign& campaign) {
  const Study& study = campaign.study;
  Table table(
      "Verdicts of the autocorrelation functions: CVs that differ from their nominal output. Lags in "
      "samples; own: "
      "1 when y_{0 diag} is like y_{0}, 0 when it is like y.",
      {{"scenario", Table::Align::left},
       {"CV", Table::Align::left},
       {"lag of y"},
       {"of y_{0}"},
       {"ratio"},
       {"own"},
       {"verdict", Table::Align::text}});
  const auto add = [&](const std::string& name, Eigen::Index cv, const AcfComparison& acf) {
    if (acf_differs(acf))
      table.row({as_label(name), as_label(cv_name(study, cv)), Number{acf.y.decay_lag},
                 Number{acf.y0.decay_lag}, Number{acf.decay_lag_ratio}, Number{acf.own_share},
                 acf_text(acf)});
  };
  Eigen::Index place = 0;
  for (const CvDiagnosis& of_cv : campaign.basis.diagnosis.cvs)
    add("basis case", place++, of_cv.acf);
  for (const ExperimentRecord& record : campaign.records)
    for (Eigen::Index cv = 0; record.chain().answered() && cv < study.cv_count(); ++cv)
      add(scenario_name(study, record), cv, cv_diagnosis(record.chain(), cv).acf);
  return table;
}

Table s0_change_table(const Study& study, const SummaryContent& parts) {
  const S0PerturbationOptions& options = study.s0_perturbation;
  Table table(
      fmt::format(
          "S_{{0}} modified, {:g} to {:g} times. tau, xi: fit of (6.24) to the diagonal of T_{{0}}; by tau, "
          "by xi: largest relative change of Ivar_{{diag}} of the affected CV when it is multiplied; in "
          "band: experiments whose ratio stays in the band of impact, {:g} to {:g}.",
          options.tolerance_lower, options.tolerance_upper, study.diagnosis.impact_lower,
          study.diagnosis.impact_upper),
      {{"CV", Table::Align::left},
       {fmt::format("tau ({})", as_label(study.plant.time_unit))},
       {"xi"},
       {"RMS error"},
       {"by tau"},
       {"in band"},
       {"by xi"},
       {"in band"},
       {"count"}});
  for (const DiagonalFit& fit : parts.s0_fits) {
    std::vector<Cell> cells{as_label(cv_name(study, fit.cv)), Number{fit.fit.model.time_constant},
                            Number{fit.fit.model.damping}, Number{fit.fit.rms_error}};
    for (const S0Curve& curve : parts.s0_curves)
      if (curve.cv == fit.cv)
        cells.insert(cells.end(),
                     {Number{curve.time_constant_change.largest},
                      Number{curve.time_constant_change.within_band.value, NumberForm::share},
                      Number{curve.damping_change.largest},
                      Number{curve.damping_change.within_band.value, NumberForm::share}, curve.experiments});
    table.row(std::move(cells));
  }
  return table;
}

Table s0_structure_table(const Study& study, const SummaryContent& parts) {
  Table table("S_{0} with " + fixed_names(study) +
                  " fixed: fit of (6.24) with all MVs available and with these fixed, and "
                  "the multipliers between the two.",
              {{"CV", Table::Align::left},
               {"tau"},
               {"xi"},
               {"tau, fixed"},
               {"xi, fixed"},
               {"tau times"},
               {"xi times"}});
  for (const StructureFit& fit : parts.structure_fits)
    table.row({as_label(cv_name(study, fit.cv)), Number{fit.available.model.time_constant},
               Number{fit.available.model.damping}, Number{fit.fixed.model.time_constant},
               Number{fit.fixed.model.damping}, Number{fit.time_constant_multiplier},
               Number{fit.damping_multiplier}});
  return table;
}

}  // namespace mpm
