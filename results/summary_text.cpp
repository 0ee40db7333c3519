#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "analysis/box_jenkins_sensitivity.hpp"
#include "results/scenario_text.hpp"
#include "results/summary.hpp"
#include "results/summary_parts.hpp"

namespace mpm {
namespace {

constexpr std::size_t kMostListed = 10;
constexpr std::size_t kNameWidth = 36;

/// A number of a table: a percentage for a share, "-" when there is none.
std::string number(double value, bool share) {
  if (std::isnan(value))
    return "-";
  return share ? fmt::format("{:.1f} %", 100.0 * value) : fmt::format("{:.3f}", value);
}

std::string interval(const Interval& interval, bool share) {
  if (std::isnan(interval.lower) || std::isnan(interval.upper))
    return "-";
  return share ? fmt::format("{:.1f} to {:.1f} %", 100.0 * interval.lower, 100.0 * interval.upper)
               : fmt::format("{:.3f} to {:.3f}", interval.lower, interval.upper);
}

/// `count` things: "1 job", "2 jobs".
std::string plural(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

class Text {
 public:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_.erase(text_.find_last_not_of(' ') + 1);  // tables pad their last column
    text_ += '\n';
  }
  /// An entry of the heading; a long value goes on in lines of its own.
  void entry(const std::string& name, const std::string& value) {
    constexpr std::size_t kValueWidth = 86;
    std::string left = value;
    std::string label = name;
    while (left.size() > kValueWidth) {
      const std::size_t blank = left.rfind(' ', kValueWidth);
      if (blank == std::string::npos || blank == 0)
        break;
      line("{:<12}  {}", label, left.substr(0, blank));
      left.erase(0, blank + 1);
      label.clear();
    }
    line("{:<12}  {}", label, left);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

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

void add_heading(Text& text, const Campaign& campaign, const SummaryParts& parts) {
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
  text.entry("self-check",
             fmt::format("{}: {}", campaign.basis.healthy ? "passed" : "FAILED", campaign.basis.explanation));
}

std::string confidence_title(const Study& study) {
  return fmt::format("{:g} % interval", 100.0 * study.aggregate.confidence);
}

void add_compared(Text& text, const Study& study, const std::vector<SummaryValue>& values) {
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
              number(value.measured.value, share), interval(range, share), value.measured.count,
              number(value.reported, share), agree);
  }
  text.line("(agree: the interval contains the reported number)");
}

/// The bins of dominance have a table of their own.
bool is_dominance(const SummaryValue& value) {
  return value.measured.name.find("_at_dominance_") != std::string::npos;
}

void add_others(Text& text, const Study& study, const std::vector<SummaryValue>& values) {
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}", "other numbers", kNameWidth, "measured", confidence_title(study),
            "count");
  for (const SummaryValue& value : values) {
    if (value.has_reported() || is_dominance(value))
      continue;
    const bool share = value.is_share();
    text.line("{:<{}}  {:>10}  {:>18}  {:>8}", value.measured.name, kNameWidth,
              number(value.measured.value, share), interval(value.measured.interval, share),
              value.measured.count);
  }
}

std::string cv_name(const Study& study, Eigen::Index cv) {
  return cv < 0 ? "no CV" : study.plant.cvs[static_cast<std::size_t>(cv)].name;
}

std::string digits(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

constexpr std::size_t kCvWidth = 32;

/// Fits and changes of the CVs at a soft limit when S0 is modified.
void add_s0_perturbation(Text& text, const Study& study, const SummaryParts& parts) {
  if (parts.s0_fits.empty())
    return;
  const S0PerturbationOptions& options = study.s0_perturbation;
  constexpr auto kRow = "{:<{}}  {:>8}  {:>6}  {:>6}  {:>8}  {:>8}  {:>8}  {:>8}";
  text.line("");
  text.line(kRow,
            fmt::format("S0 modified, {:g} to {:g} times", options.tolerance_lower, options.tolerance_upper),
            kCvWidth, "tau", "xi", "count", "by tau", "in band", "by xi", "in band");
  for (const DiagonalFit& fit : parts.s0_fits) {
    S0Curve none{fit.cv, 0, {}, {}, {}, {}};
    none.time_constant_change.within_band = none.damping_change.within_band = rate(0, 0);
    const S0Curve* curve = &none;
    for (const S0Curve& known : parts.s0_curves)
      if (known.cv == fit.cv)
        curve = &known;
    text.line(kRow, cv_name(study, fit.cv), kCvWidth, digits(fit.fit.model.time_constant),
              digits(fit.fit.model.damping), curve->experiments, digits(curve->time_constant_change.largest),
              number(curve->time_constant_change.within_band.value, true),
              digits(curve->damping_change.largest), number(curve->damping_change.within_band.value, true));
  }
  text.line("(tau, xi: fit of (6.24) to T0; by tau, by xi: largest relative change of Ivar_diag of the");
  text.line("affected CV when it is multiplied; in band: experiments whose change keeps to {:g} to {:g})",
            study.diagnosis.impact_lower, study.diagnosis.impact_upper);
}

/// The fits with MVs fixed, and their multipliers.
void add_structures(Text& text, const Study& study, const std::vector<StructureFit>& fits) {
  if (fits.empty())
    return;
  std::string fixed;
  for (const Eigen::Index mv : study.s0_perturbation.fixed_mvs)
    fixed += (fixed.empty() ? "" : ", ") + study.plant.mvs[static_cast<std::size_t>(mv)].name;
  text.line("");
  text.line("{:<{}}  {:>8}  {:>6}  {:>10}  {:>10}", "S0 with " + fixed + " fixed", kCvWidth, "tau", "xi",
            "tau times", "xi times");
  for (const StructureFit& fit : fits)
    text.line("{:<{}}  {:>8}  {:>6}  {:>10}  {:>10}", cv_name(study, fit.cv), kCvWidth,
              digits(fit.fixed.model.time_constant), digits(fit.fixed.model.damping),
              digits(fit.time_constant_multiplier), digits(fit.damping_multiplier));
}

void add_dominance(Text& text, const Study& study, const std::vector<DominanceBin>& bins) {
  if (bins.empty())
    return;
  text.line("");
  text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}", "I_MPM by dominance of the mismatch", kNameWidth, "mean",
            confidence_title(study), "count", fmt::format("> {:g}", study.diagnosis.mpm_threshold));
  for (const DominanceBin& bin : bins)
    text.line("{:<{}}  {:>10}  {:>18}  {:>8}  {:>10}", fmt::format("{:g} to {:g}", bin.lower, bin.upper),
              kNameWidth, number(bin.i_mpm.mean, false), interval(bin.i_mpm.mean_interval, false),
              bin.i_mpm.count, number(bin.above_threshold.value, true));
}

void add_more(Text& text, std::size_t count) {
  if (count > kMostListed)
    text.line("  and {} more", count - kMostListed);
}

void add_failed(Text& text, const std::vector<const ExperimentRecord*>& failed) {
  if (failed.empty())
    return;
  text.line("");
  text.line("{} failed:", plural(failed.size(), "experiment"));
  for (std::size_t i = 0; i < std::min(failed.size(), kMostListed); ++i)
    text.line("  {:>5}  {}", failed[i]->draw.index, failed[i]->message);
  add_more(text, failed.size());
}

void add_wrong(Text& text, const Study& study, const std::vector<const ExperimentRecord*>& wrong,
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

/// An index of every CV, one line a scenario; a star marks what lies outside the band of impact.
void add_scenario_indices(Text& text, const Campaign& campaign, const char* name,
                          Eigen::VectorXd Diagnosis::*index) {
  const Study& study = campaign.study;
  const auto row = [&](const std::string& first, const std::vector<std::string>& cells) {
    std::string line = fmt::format("{:<14}", first);
    for (const std::string& cell : cells)
      line += fmt::format("  {:>9}", cell);
    text.line("{}", line);
  };
  text.line("");
  std::vector<std::string> cells;
  for (const PlantModel::Variable& cv : study.plant.cvs)
    cells.push_back(cv.name + " ");
  row(name, cells);
  for (const ExperimentRecord& record : campaign.records) {
    cells.clear();
    for (const double value : record.diagnosis.*index)
      cells.push_back(digits(value) + (study.diagnosis.has_impact(value) ? "*" : " "));
    row(scenario_name(study, record), cells);
  }
}

/// The indicators of the flagged CVs.
void add_scenario_indicators(Text& text, const Campaign& campaign) {
  const Study& study = campaign.study;
  constexpr auto kRow = "{:<14}  {:<10}  {:>8}  {:>8}  {:>8}  {:>8}";
  text.line("");
  text.line(kRow, "flagged CVs", "CV", "I_MPM", "co_dkts", "co_dskn", "SSE");
  for (const ExperimentRecord& record : campaign.records)
    for (std::size_t i = 0; i < record.diagnosis.cvs.size(); ++i) {
      const CvDiagnosis& cv = record.diagnosis.cvs[i];
      if (cv.flagged)
        text.line(kRow, scenario_name(study, record), study.plant.cvs[i].name,
                  digits(cv.distribution.mpm.i_mpm), digits(cv.distribution.mpm.co_dkts),
                  digits(cv.distribution.mpm.co_dskn), digits(cv.sse));
    }
  text.line("(* outside the band of impact)");
}

/// The CVs whose autocorrelation functions differ from those of their nominal outputs.
void add_autocorrelations(Text& text, const Campaign& campaign) {
  const Study& study = campaign.study;
  constexpr auto kRow = "{:<14}  {:<10}  {:>8}  {:>8}  {:>8}  {}";
  text.line("");
  text.line(kRow, "ACF", "CV", "lag y", "lag y0", "own", "verdict");
  bool any = false;
  const auto row = [&](const std::string& name, std::size_t cv, const AcfComparison& acf) {
    if (!acf_differs(acf))
      return;
    any = true;
    text.line(kRow, name, study.plant.cvs[cv].name, digits(acf.y.decay_lag), digits(acf.y0.decay_lag),
              digits(acf.own_share), acf_text(acf));
  };
  for (std::size_t cv = 0; cv < campaign.basis.acf.size(); ++cv)
    row("basis case", cv, campaign.basis.acf[cv]);
  for (const ExperimentRecord& record : campaign.records)
    for (std::size_t cv = 0; cv < record.diagnosis.cvs.size(); ++cv)
      row(scenario_name(study, record), cv, record.diagnosis.cvs[cv].acf);
  text.line("({}; lags in samples; own: 1 when y0_diag is like y0, 0 when it is like y)",
            any ? "CVs that differ from their nominal output" : "no CV differs from its nominal output");
}

/// What the chain says of each scenario against what the study says.
void add_scenarios(Text& text, const Campaign& campaign) {
  const Study& study = campaign.study;
  const DiagnosisOptions& options = study.diagnosis;
  constexpr auto kRow = "{:<14}  {:<24}  {:<24}  {:>8}  {}";
  text.line("");
  text.line(kRow, "named scenarios", "affected", "flagged", "TSSE", "verdict");
  for (const ExperimentRecord& record : campaign.records)
    text.line(kRow, scenario_name(study, record), affected_text(study, record.draw),
              flagged_text(study, record.diagnosis), digits(total_simulation_error(record.diagnosis)),
              scenario_verdict_text(study, record));
  text.line("(flagged: Ivar_diag outside {:g} to {:g}; source by I_MPM above or below {:g})",
            options.impact_lower, options.impact_upper, options.mpm_threshold);
  add_scenario_indices(text, campaign, "Ivar", &Diagnosis::ivar);
  add_scenario_indices(text, campaign, "Ivar_diag", &Diagnosis::ivar_diag);
  add_scenario_indicators(text, campaign);
  add_autocorrelations(text, campaign);
}

}  // namespace

std::string summary_text(const Campaign& campaign, const std::string& file) {
  const SummaryParts parts = summary_parts(campaign);
  Text text;
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
  add_structures(text, campaign.study, parts.structure_fits);
  add_failed(text, parts.failed);
  add_wrong(text, campaign.study, parts.wrong, file);
  return text.take();
}

}  // namespace mpm
