#include "results/report/report_answers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "results/document/words.hpp"
#include "results/plot/plot_text.hpp"
#include "results/summary/comparison.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

double confidence_of(const ReportInput& input) {
  return input.campaign.study.aggregate.confidence;
}

std::string asked(const ReportInput& input) {
  const Study& study = input.campaign.study;
  const std::size_t methods = input.findings().methods.size();
  return fmt::format(
      "{} when loops of this plant ({}) run badly, {} which {} is hurt, and whether a wrong model ({}) or an "
      "unmeasured "
      "disturbance ({}) does it? {} closed loops, {}.",
      strong("Asked:"), as_label(study.plant.title),
      methods == 1 ? fmt::format("does the method {} tell", code(input.findings().methods.front().name()))
                   : fmt::format("do {} methods tell", methods),
      link("term-cv", "CV"), link("term-mpm", "MPM"), link("term-ud", "UD"), input.findings().experiments,
      kinds_text(input.campaign.study, input.parts.kinds));
}

/// The result if no method names a source: that of the method that finds the CV most often. Empty if none
/// names a CV.
std::string found_of_cvs(const ReportInput& input) {
  const MethodFindings* const best = best_method(input.findings(), "located");
  if (best == nullptr)
    return "";
  return fmt::format(
      "no method names a source; {} flags {} of the loops with a fault and finds the CV most often, in {} of "
      "the loops it flags",
      code(best->name()), share_words(best->rates["detected"]), share_words(best->rates["located"]));
}

std::string found(const ReportInput& input) {
  if (input.campaign.study.names_scenarios()) {
    const Rate right = input.findings().right_scenarios;
    return right.total == 0
               ? "no scenario has a verdict."
               : fmt::format("every CV and every source is right in {} of {} scenarios with a verdict.",
                             right.hits, right.total);
  }
  std::string text;
  if (const Rate located = input.findings().located; located.total > 0)
    text = fmt::format("the chain of the thesis sees an impact in {} loops and finds the CV in {} of them",
                       located.total, share_words(located));
  if (const Rate source = input.findings().source_recognised; source.total > 0)
    text += fmt::format("{}the source of a single fault in {}",
                        text.empty() ? "the chain of the thesis names " : " and ", share_words(source));
  if (const MethodFindings* const best = best_method(input.findings(), "source");
      best != nullptr && best != input.findings().chain())
    text += fmt::format("{}{} names the source most often, in {} of the loops it flags",
                        text.empty() ? "" : "; ", code(best->name()), share_words(best->rates["source"]));
  if (text.empty())
    text = found_of_cvs(input);
  if (!text.empty())
    return text + "." + own_methods_words(input.findings());
  return was_judged(input.findings()) ? "no method both answers nearly always and detects most faults."
                                      : "no loop has a verdict that can be judged.";
}

/// Says what a plant should do with the verdicts of `who`. The limits are those of a tool that is right nine
/// times in ten.
std::string advice_on(const std::string& who, const Rate& located, const Rate& source) {
  constexpr double kReliable = 0.9;
  if (located.total > 0 && located.interval.lower < kReliable)
    return fmt::format("do not re-identify a channel on the verdict of {} alone: it may be the wrong CV.",
                       who);
  if (source.total > 0 && source.interval.lower >= kReliable)
    return fmt::format("act on both the CV and the source that {} names.", who);
  return fmt::format(
      "check the CV that {} names, but investigate further before you re-identify: the source it names is "
      "too uncertain.",
      who);
}

/// Gives advice on the method that found() calls the best, so that the two agree.
std::string advice(const ReportInput& input) {
  if (!input.campaign.basis.healthy)
    return "do not use these numbers: the basis case failed its self-check. Repair the study first.";
  if (input.campaign.study.names_scenarios())
    return "read the scenarios that went wrong, one by one.";
  const MethodFindings* const best = best_method(input.findings(), "source");
  if (best != nullptr && best != input.findings().chain())
    return advice_on(code(best->name()), best->rates["located"], best->rates["source"]);
  if (input.kinds().empty())
    return "compare detection and false alarms of the methods below before you choose one.";
  const Rate located = input.findings().located;
  if (located.total == 0)
    return "draw larger faults: the chain sees no impact of these.";
  return advice_on("this chain", located, input.findings().source_recognised);
}

/// "MPM 71.0 % (60.0 to 80.0), UD 85 % (...)", for the kinds that count any loop.
std::string by_kind(const ReportInput& input, Rate KindFindings::*member) {
  std::string text;
  for (const KindFindings& kind : input.kinds())
    if ((kind.*member).total > 0)
      text +=
          fmt::format("{}{} {}", text.empty() ? "" : ", ", kind_name(kind.kind), share_words(kind.*member));
  return text;
}

}  // namespace

std::string verdict_html(const ReportInput& input) {
  std::string html;
  for (const std::string& words :
       {asked(input), strong("Found:") + " " + found(input), strong("To do:") + " " + advice(input)})
    html += "<p>" + words_html(words) + "</p>\n";
  return "<div class=\"verdict\">\n" + html + "</div>\n";
}

std::string rates_answer(const ReportInput& input) {
  const std::vector<Finding>& rows = input.findings().rows;
  std::int64_t compared = 0, agree = 0;
  for (const Finding& row : rows)
    if (const std::optional<bool> agrees = row.agrees(confidence_of(input))) {
      ++compared;
      agree += *agrees ? 1 : 0;
    }
  const Rate located = input.findings().located;
  const Rate source = input.findings().source_recognised;
  std::string text;
  if (located.total > 0)
    text = fmt::format(
        "The CV is right in {} of {} loops{}. ", share_words(located), located.total,
        source.total == 0 ? "" : fmt::format(", the source in {} of {}", share_words(source), source.total));
  if (compared > 0)
    text += fmt::format("{} of {} numbers agree with the reported ones.", agree, compared);
  return text;
}

std::string false_alarm_answer(const ReportInput& input) {
  const Rate& all = input.findings().false_alarm;
  return all.total == 0
             ? ""
             : fmt::format("In {} of the {} loops without any fault the chain sees a modelling error.",
                           share_words(all), all.total);
}

std::string variance_answer(const ReportInput& input) {
  std::string text;
  double least = 1.0, largest = 0.0;
  for (const KindFindings& kind : input.kinds()) {
    const LinearFitIntervals& fit = kind.regression;
    if (!std::isfinite(fit.fit.r_squared) || !std::isfinite(fit.r_squared.lower))
      continue;
    least = std::min(least, fit.r_squared.lower);
    largest = std::max(largest, fit.r_squared.upper);
    text += fmt::format("{}{:.2f}{} for {}", text.empty() ? "" : ", ", fit.fit.r_squared,
                        interval_words(fit.r_squared, 2), kind_name(kind.kind));
  }
  if (text.empty())
    return "";
  const char* const word = least > 0.7 ? "Yes" : largest < 0.5 ? "Hardly" : "In part";
  return fmt::format(
      "{}: a straight line in Ivar explains this share of the variance of Ivar_{{basis}}, R\xC2\xB2 "
      "= {}.",
      word, text);
}

std::string location_answer(const ReportInput& input) {
  const std::string kinds = by_kind(input, &KindFindings::located);
  return kinds.empty() ? "" : "The located CV is the one with the fault in: " + kinds + ".";
}

std::string indicator_answer(const ReportInput& input) {
  const std::string kinds = by_kind(input, &KindFindings::source_recognised);
  return kinds.empty() ? ""
                       : fmt::format("With the threshold {:g} the source is named rightly in: {}.",
                                     mpm_threshold(input.campaign.study), kinds);
}

std::string dominance_answer(const ReportInput& input) {
  const std::vector<DominanceBin>& bins = input.findings().dominance;
  if (bins.empty() || bins.front().i_mpm.count == 0 || bins.back().i_mpm.count == 0)
    return "";
  const auto words = [](const DominanceBin& bin) {
    return fmt::format("{} where the mismatch has a share from {:g} to {:g}",
                       share_words(bin.above_threshold), bin.lower, bin.upper);
  };
  const bool apart = bins.front().above_threshold.interval.upper < bins.back().above_threshold.interval.lower;
  return fmt::format("{}: I_{{MPM}} calls the loop a mismatch in {}, and in {}.",
                     apart ? "At the one that dominates" : "At the one that dominates, if at all",
                     words(bins.front()), words(bins.back()));
}

std::string roc_answer(const RocCurve& curve, const Interval& area, const RocPoint& at_study) {
  return fmt::format(
      "In {:.1f} %{} of random pairs of a mismatch and a disturbance, the mismatch has the larger I_{{MPM}}. "
      "The best threshold has a J of {:.2f}, that of the study {:.2f}.",
      100.0 * curve.area, interval_words({100.0 * area.lower, 100.0 * area.upper}, 1), curve.best.youden(),
      at_study.youden());
}

std::string fault_size_answer(const std::vector<SizedFault>& faults, double confidence) {
  std::int64_t missed = 0, wrong = 0;
  for (const SizedFault& fault : faults) {
    missed += fault.flagged ? 0 : 1;
    wrong += fault.flagged && !fault.diagnosed ? 1 : 0;
  }
  const auto total = static_cast<std::int64_t>(faults.size());
  return faults.empty() ? ""
                        : fmt::format(
                              "Of {} single faults, {} are too small for a visible impact, and {} are seen "
                              "but assigned to a wrong CV or source.",
                              total, share_words(rate(missed, total, confidence)),
                              share_words(rate(wrong, total, confidence)));
}

std::string s0_answer(const ReportInput& input) {
  const std::optional<S0Changes>& changes = input.findings().s0_changes;
  if (!changes || !std::isfinite(changes->time_constant.largest))
    return "";
  const S0PerturbationOptions& options = input.campaign.study.s0_perturbation;
  return fmt::format(
      "With a time constant of {:g} to {:g} times the true one, Ivar_{{diag}} changes by at most {:.1f} % "
      "and stays in the band of impact in {} of the loops; with such a damping, by at most {:.1f} % and in "
      "{}.",
      options.tolerance_lower, options.tolerance_upper, 100.0 * changes->time_constant.largest,
      share_words(changes->time_constant.within_band), 100.0 * changes->damping.largest,
      share_words(changes->damping.within_band));
}

std::string interaction_answer(const ReportInput& input, const LoopInteraction& interaction) {
  std::string gains;
  if (interaction.relative_gain_at_maximum.rows() == interaction.relative_gain_at_maximum.cols())
    for (Eigen::Index i = 0; i < interaction.relative_gain_at_maximum.rows(); ++i)
      gains += fmt::format("{}{:.2f}", gains.empty() ? "" : ", ", interaction.relative_gain_at_maximum(i, i));
  return fmt::format(
      "RPN is largest, {:.2f}, at {:.3g} rad/{}{}.", interaction.rpn_maximum, interaction.rpn_frequency,
      as_label(input.campaign.study.plant.time_unit),
      gains.empty() ? ""
                    : ", where the diagonal of the RGA has the magnitudes " + gains + " (1: no interaction)");
}

}  // namespace mpm
