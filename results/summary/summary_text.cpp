#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/chain_numbers.hpp"
#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "analysis/sensitivity/loop_interaction.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/summary_content.hpp"
#include "results/summary/summary_lines.hpp"
#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::string audit_sentence(const SummaryContent& parts, const CampaignInfo& info) {
  const AuditSummary& audit = parts.audit;
  const std::string fallbacks =
      parts.fallbacks == 0 ? "no problem fell back to Ipopt"
                           : fmt::format("{} fell back to Ipopt",
                                         plural(static_cast<std::size_t>(parts.fallbacks), "problem"));
  if (audit.steps == 0)
    return fallbacks + "; no step audited";
  return fmt::format(
      "{}; {} also solved by Ipopt: {} with another status, moves differ by at most {:.1e}, targets by "
      "{:.1e}, objectives by {:.1e}; {:.1f} s of processor time",
      fallbacks, plural(static_cast<std::size_t>(audit.steps), "step"), audit.disagreements,
      audit.largest_move, audit.largest_target, audit.largest_objective, info.audit_seconds);
}

std::string identification_sentence(const Study& study, const BasisCase& basis) {
  const Eigen::VectorXd largest = largest_differences(basis.sensitivity, *basis.sensitivity_direct);
  std::string sentence = "Box-Jenkins models; largest difference from the direct step responses:";
  for (Eigen::Index a = 0; a < largest.size(); ++a) {
    const auto cv = static_cast<std::size_t>(basis.sensitivity.active[static_cast<std::size_t>(a)].cv);
    sentence += fmt::format("{} {} {:.2g}", a == 0 ? "" : ",", study.plant.cvs[cv].name, largest(a));
  }
  return sentence;
}

/// Where the controller works, and how its loops interact there.
std::string interaction_sentence(const Study& study, const BasisCase& basis) {
  const LoopInteraction interaction = loop_interaction(study, basis.point, basis.sensitivity);
  if (interaction.frequency.size() == 0)
    return "no CV is at a setpoint or a soft limit";
  std::string sentence =
      fmt::format("RPN (4.16) is largest at {:.3g} rad/{}, {:.3g}", interaction.rpn_frequency,
                  study.plant.time_unit, interaction.rpn_maximum);
  for (std::size_t i = 0; i < interaction.mvs.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    sentence += fmt::format("{} {}-{} {:.3g}", i == 0 ? "; |RGA| there:" : ",",
                            study.plant.cvs[static_cast<std::size_t>(interaction.cvs[i])].name,
                            mv_name(study, interaction.mvs[i]), interaction.relative_gain_at_maximum(at, at));
  }
  return sentence;
}

void add_heading(SummaryLines& text, const Campaign& campaign, const SummaryContent& parts) {
  const StudyFindings& findings = parts.findings;
  const Study& study = campaign.study;
  const PlantModel& plant = study.plant;
  const CampaignInfo& info = campaign.info;
  text.entry("study", fmt::format("{}: {}", study.name, study.title));
  text.entry("plant", fmt::format("{}: {}, {}, {}", plant.name, plural(plant.cvs.size(), "CV"),
                                  plural(plant.mvs.size(), "MV"), plural(plant.mds.size(), "MD")));
  text.entry("controller",
             fmt::format("sample time {:g} {}, prediction horizon {}, control horizon {}",
                         study.controller.sample_time, plant.time_unit, study.controller.prediction_horizon,
                         study.controller.control_horizon));
  if (study.controller_program)
    text.entry("is a program", fmt::format("`{}`: its answers are neither certified nor audited",
                                           fmt::join(study.controller_program->command(), " ")));
  if (!campaign.basis.sensitivity.is_known)
    text.entry("S0", "none: the program runs on the plant only, not on its own model");
  text.entry("experiments",
             fmt::format("{} ({}) of {} samples; {}", findings.experiments, kinds_text(study, parts.kinds),
                         study.simulation.samples, endings_text(study, findings)));
  text.entry("seed", fmt::format("{}", study.seed));
  text.entry("program", fmt::format("mpmbench {} ({}), solver {}", info.mpmbench_version,
                                    info.git_sha.empty() ? "unknown revision" : info.git_sha, info.solver));
  if (!info.outside_files.empty())
    text.entry("from outside", info.outside_files);
  text.entry("run", fmt::format("{}, {:.1f} s with {}", info.created, info.seconds,
                                plural(static_cast<std::size_t>(std::max(info.jobs, 0)), "job")));
  if (info.solver == "auto" && !study.controller_program)
    text.entry("audit", audit_sentence(parts, info));
  if (campaign.basis.sensitivity_direct)
    text.entry("T0", identification_sentence(study, campaign.basis));
  text.entry("interaction", interaction_sentence(study, campaign.basis));
  text.entry("self-check",
             fmt::format("{}: {}", campaign.basis.healthy ? "passed" : "FAILED", campaign.basis.explanation));
}

std::string confidence_title(const Study& study) {
  return fmt::format("{:g} % interval", 100.0 * study.aggregate.confidence);
}

void add_compared(SummaryLines& text, const Study& study, const std::vector<Finding>& rows) {
  if (std::none_of(rows.begin(), rows.end(), [](const Finding& row) { return row.has_reported(); }))
    return;
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}  {}", "measured against reported", kNameWidth, "measured",
            confidence_title(study), "count", "reported", "agree");
  for (const Finding& row : rows) {
    if (!row.has_reported())
      continue;
    const bool share = row.is_share();
    const std::optional<bool> agrees = row.agrees(study.aggregate.confidence);
    const char* agree = !agrees ? "-" : *agrees ? "yes" : "no";
    text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}  {}", row.name, kNameWidth,
              number_text(row.value, share), interval_text(row.interval, share), row.count,
              number_text(row.reported, share), agree);
  }
  text.line(
      "(agree: a share with the sampling error of both, where the study tells that of the reported one;");
  text.line(" any other number when the interval contains the reported one)");
}

/// What has no table of its own: bins of dominance, and methods, when there are several.
bool is_other(const Finding& row) {
  return !row.has_reported() && row.prominence != Prominence::detail &&
         row.group != FindingGroup::dominance && row.group != FindingGroup::method;
}

void add_others(SummaryLines& text, const Study& study, const std::vector<Finding>& rows) {
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}", "other numbers", kNameWidth, "measured", confidence_title(study),
            "count");
  for (const Finding& row : rows)
    if (is_other(row))
      text.line("{:<{}}  {:>10}  {:>18}  {:>8}", row.name, kNameWidth, number_text(row.value, row.is_share()),
                interval_text(row.interval, row.is_share()), row.count);
}

void add_dominance(SummaryLines& text, const Study& study, const std::vector<DominanceBin>& bins) {
  if (bins.empty())
    return;
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}", "I_MPM by dominance of the mismatch", kNameWidth, "mean",
            confidence_title(study), "count", fmt::format("> {:g}", study.diagnosis.mpm_threshold));
  for (const DominanceBin& bin : bins)
    text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}", fmt::format("{:g} to {:g}", bin.lower, bin.upper),
              kNameWidth, number_text(bin.i_mpm.mean, false), interval_text(bin.i_mpm.mean_interval, false),
              bin.i_mpm.count, number_text(bin.above_threshold.value, true));
}

void add_more(SummaryLines& text, std::size_t count) {
  if (count > kMostListed)
    text.line("  and {} more", count - kMostListed);
}

void add_failed(SummaryLines& text, const SummaryContent& parts) {
  if (parts.failures.empty())
    return;
  text.line("");
  text.line("{} failed:", plural(parts.failures.size(), "experiment"));
  for (std::size_t i = 0; i < std::min(parts.failures.size(), kMostListed); ++i)
    text.line("  {:>5}  {}", parts.failures[i].index, parts.failures[i].message);
  add_more(text, parts.failures.size());
}

void add_wrong(SummaryLines& text, const Study& study, const SummaryContent& parts, const std::string& file) {
  const std::vector<const ExperimentRecord*>& wrong = parts.wrong;
  text.line("");
  text.line("{} with impact got a wrong verdict{}", plural(parts.wrong_verdicts.size(), "experiment"),
            wrong.empty() ? "" : ":");
  for (std::size_t i = 0; i < std::min(wrong.size(), kMostListed); ++i) {
    const ExperimentDraw& draw = wrong[i]->draw;
    const AssessmentRecord& said = *wrong[i]->by(kChainMethod);
    const std::string truth = is_faultless(draw.kind) ? std::string(to_string(draw.kind))
                                                      : fmt::format("{} on {}", to_string(draw.kind),
                                                                    cv_name(study, draw.true_cv()));
    text.line("  {:<{}}  # {}, found {} on {}", fmt::format("mpmbench replay {} {}", file, draw.index),
              file.size() + 22, truth, to_string(said.predicted_source),
              said.predicted_cv < 0 ? "no CV" : cv_name(study, said.predicted_cv));
  }
  add_more(text, parts.wrong_verdicts.size());
}

}  // namespace

std::string summary_text(const Campaign& campaign, const StudyFindings& findings, const std::string& file,
                         const std::optional<Unfinished>& unfinished) {
  const SummaryContent parts = summary_content(campaign, findings);
  const bool chain = findings.chain() != nullptr;
  SummaryLines text;
  if (unfinished)
    text.line(
        "PARTIAL: {} of {} experiments. The run is not finished, and what is done is no random sample: slow\n"
        "loops come last. `replay` needs the archive.\n",
        unfinished->done, unfinished->experiments);
  add_heading(text, campaign, parts);
  if (campaign.study.names_scenarios()) {
    if (chain)
      add_scenarios(text, campaign);
  } else {
    add_compared(text, campaign.study, findings.rows);
    add_others(text, campaign.study, findings.rows);
    add_dominance(text, campaign.study, findings.dominance);
    add_s0_perturbation(text, campaign.study, parts);
  }
  add_failed(text, parts);
  if (!campaign.study.names_scenarios() && chain)
    add_wrong(text, campaign.study, parts, file);
  if (findings.methods.size() > 1 || !chain)
    text.line("\n{}", comparison_text(campaign, findings));
  return text.take();
}

}  // namespace mpm
