#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "analysis/sensitivity/loop_interaction.hpp"
#include "results/summary/summary.hpp"
#include "results/summary/summary_lines.hpp"
#include "results/summary/summary_parts.hpp"
#include "results/summary/summary_sections.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostListed = 10;

std::string audit_sentence(const SummaryParts& parts, const CampaignInfo& info) {
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
                            study.plant.mvs[static_cast<std::size_t>(interaction.mvs[i])].name,
                            interaction.relative_gain_at_maximum(at, at));
  }
  return sentence;
}

void add_heading(SummaryLines& text, const Campaign& campaign, const SummaryParts& parts) {
  const StudyAggregate& aggregate = parts.aggregate;
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
  std::string kinds = study.names_scenarios() ? "named scenarios" : "";
  for (const KindAggregate& kind : aggregate.kinds)
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", kind.experiments, to_string(kind.kind));
  for (const FalseAlarms& group : aggregate.false_alarms)
    if (!group.parameter)
      kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", group.experiments, group.name());
  text.entry("experiments",
             fmt::format("{} ({}) of {} samples; {} infeasible, {} failed", aggregate.experiments, kinds,
                         study.simulation.samples, aggregate.infeasible.hits, aggregate.failed));
  text.entry("seed", fmt::format("{}", study.seed));
  text.entry("program", fmt::format("mpmbench {} ({}), solver {}", info.mpmbench_version,
                                    info.git_sha.empty() ? "unknown revision" : info.git_sha, info.solver));
  text.entry("run", fmt::format("{}, {:.1f} s with {}", info.created, info.seconds,
                                plural(static_cast<std::size_t>(std::max(info.jobs, 0)), "job")));
  if (info.solver == "auto")
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

void add_compared(SummaryLines& text, const Study& study, const std::vector<SummaryValue>& values) {
  if (std::none_of(values.begin(), values.end(), [](const auto& v) { return v.has_reported(); }))
    return;
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}  {}", "measured against reported", kNameWidth, "measured",
            confidence_title(study), "count", "reported", "agree");
  for (const SummaryValue& value : values) {
    if (!value.has_reported())
      continue;
    const bool share = value.is_share();
    const Interval& range = value.measured.interval;
    const char* agree = std::isnan(range.lower) ? "-" : range.contains(value.reported) ? "yes" : "no";
    text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}  {}", value.measured.name, kNameWidth,
              number_text(value.measured.value, share), interval_text(range, share), value.measured.count,
              number_text(value.reported, share), agree);
  }
  text.line("(agree: the interval contains the reported number)");
}

/// The bins of dominance have a table of their own.
bool is_dominance(const SummaryValue& value) {
  return value.measured.name.find("_at_dominance_") != std::string::npos;
}

void add_others(SummaryLines& text, const Study& study, const std::vector<SummaryValue>& values) {
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}", "other numbers", kNameWidth, "measured", confidence_title(study),
            "count");
  for (const SummaryValue& value : values) {
    if (value.has_reported() || is_dominance(value))
      continue;
    const bool share = value.is_share();
    text.line("{:<{}}  {:>10}  {:>18}  {:>8}", value.measured.name, kNameWidth,
              number_text(value.measured.value, share), interval_text(value.measured.interval, share),
              value.measured.count);
  }
}

std::string cv_name(const Study& study, Eigen::Index cv) {
  return cv < 0 ? "no CV" : study.plant.cvs[static_cast<std::size_t>(cv)].name;
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

void add_failed(SummaryLines& text, const std::vector<const ExperimentRecord*>& failed) {
  if (failed.empty())
    return;
  text.line("");
  text.line("{} failed:", plural(failed.size(), "experiment"));
  for (std::size_t i = 0; i < std::min(failed.size(), kMostListed); ++i)
    text.line("  {:>5}  {}", failed[i]->draw.index, failed[i]->message);
  add_more(text, failed.size());
}

void add_wrong(SummaryLines& text, const Study& study, const std::vector<const ExperimentRecord*>& wrong,
               const std::string& file) {
  text.line("");
  text.line("{} with impact got a wrong verdict{}", plural(wrong.size(), "experiment"),
            wrong.empty() ? "" : ":");
  for (std::size_t i = 0; i < std::min(wrong.size(), kMostListed); ++i) {
    const ExperimentDraw& draw = wrong[i]->draw;
    const Diagnosis& verdict = wrong[i]->diagnosis;
    const std::string truth = is_faultless(draw.kind) ? std::string(count_name(draw.kind))
                                                      : fmt::format("{} on {}", to_string(draw.kind),
                                                                    cv_name(study, draw.true_cv()));
    text.line("  {:<{}}  # {}, found {} on {}", fmt::format("mpmbench replay {} {}", file, draw.index),
              file.size() + 22, truth, to_string(verdict.predicted_source),
              cv_name(study, verdict.predicted_cv));
  }
  add_more(text, wrong.size());
}

}  // namespace

std::string summary_text(const Campaign& campaign, const std::string& file) {
  const SummaryParts parts = summary_parts(campaign);
  SummaryLines text;
  add_heading(text, campaign, parts);
  if (campaign.study.names_scenarios()) {
    add_scenarios(text, campaign);
    add_failed(text, parts.failed);
    return text.take();
  }
  add_compared(text, campaign.study, parts.values);
  add_others(text, campaign.study, parts.values);
  add_dominance(text, campaign.study, parts.aggregate.dominance);
  add_s0_perturbation(text, campaign.study, parts);
  add_failed(text, parts.failed);
  add_wrong(text, campaign.study, parts.wrong, file);
  return text.take();
}

}  // namespace mpm
