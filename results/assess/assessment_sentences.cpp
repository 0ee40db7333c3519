#include "results/assess/assessment_sentences.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/repair_form.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

using Texts = std::vector<std::string>;

std::string share_text(const Rate& rate) {
  return fmt::format("{:.0f} % [{:.0f}, {:.0f}]", 100.0 * rate.value, 100.0 * rate.interval.lower,
                     100.0 * rate.interval.upper);
}

/// Names the signals that methods name as inputs missing in the model.
void add_candidates(const RecordAssessment& of, Texts& sentences) {
  Texts named;
  for (const AssessmentRecord& said : of.said)
    for (Eigen::Index cv = 0; said.answered() && cv < of.study.cv_count(); ++cv)
      if (const std::string candidate = named_candidate(of, said, cv); !candidate.empty())
        named.push_back(fmt::format("{} for {} (log10 p = {:.1f})", candidate, cv_name(of.study, cv),
                                    number_of_cv(said, "log10_p", cv)));
  if (!named.empty())
    sentences.push_back(
        fmt::format("Signals outside of the model that drive its errors: {}.", fmt::join(named, ", ")));
}

/// Says what the record tells about the channel that the verdict names, and which other channel is worth a
/// repair.
void add_repair(const RecordAssessment& of, Texts& sentences) {
  if (!of.no_repair.empty())
    sentences.push_back(fmt::format("The gain of a repair is not known: {}.", of.no_repair));
  if (of.repair && !of.repair->repair.parameter)  // for one parameter the verdict has the size
    sentences.push_back(fmt::format("Identified again from this record, {} has {}.",
                                    channel_name(of.study, of.repair->repair.channel),
                                    correction_text(of.study, of.repair->repair)));
  if (of.repair && of.information)
    sentences.push_back(information_sentence(of.study, of.repair->repair.channel, *of.information));
  const auto& options = of.study.assessment.of<AdequacyOptions>();
  const auto best = std::find_if(of.prospects.begin(), of.prospects.end(),
                                 [](const RepairProspect& prospect) { return prospect.is_proposed(); });
  if (best != of.prospects.end() && &*best != of.named_prospect() &&
      best->probability_above(options.worth) > options.probability)
    sentences.push_back(
        fmt::format("Of all repairs that worsen no CV, that of {} would bring most: it is expected to save "
                    "{:.0f} % of the cost of the loop, and more than {:g} % with a probability of {:.0f} %.",
                    channel_name(of.study, best->repair.channel), 100.0 * best->gain(), 100.0 * options.worth,
                    100.0 * best->probability_above(options.worth)));
}

/// What the simulated records have in common with this one.
std::string worlds_text(const RecordAssessment& of) {
  return of.model_error > 0.0 ? fmt::format("models that are {:.3g} % off in every channel",
                                            100.0 * kWorseWorlds * of.model_error)
                              : std::string("an exact model");
}

void add_trust(const RecordAssessment& of, Texts& sentences) {
  if (!of.trial) {
    sentences.push_back(fmt::format("How far to trust this is not known: {}.", of.no_trial));
    return;
  }
  const MethodRates& rates = of.trial->model.rates;
  sentences.push_back(
      fmt::format("Of {} simulated records like this one, with {}, the model was said to fail in {} of those "
                  "without a fault, each half of them against the threshold of the other half, and in "
                  "{} of those with one ({} where it had an impact).",
                  of.trial->loops, worlds_text(of), share_text(rates["false_alarm_healthy"]),
                  share_text(rates["detected"]), share_text(rates["detected_impact"])));
  const TrialCounts& counts = of.trial->counts;
  const bool fails = of.verdict.model.answer == ModelAnswer::fails;
  if (fails ? counts.above > 0 : counts.below > 0)
    sentences.push_back(
        fails ? fmt::format("The model was said to fail in {} of them, and {} of these had a fault.",
                            counts.above, counts.above - counts.healthy_above)
              : fmt::format("The model was said to explain {} of them, and {} of these had no fault.",
                            counts.below, counts.healthy_below));
  if (fails && counts.same > 0)
    sentences.push_back(
        fmt::format("The same source was named in {} of them, in {} rightly.", counts.same, counts.right));
  else if (fails)
    sentences.emplace_back(
        "This source was named in none of them, so it is not known how often it is right.");
}

/// Says in what respect the controller that ran may differ.
std::string difference_sentence(const RecordAssessment& of) {
  const ControllerCheck& check = of.controller;
  if (!check.away.empty()) {
    Texts names;
    for (const Eigen::Index cv : check.away)
      names.push_back(cv_name(of.study, cv));
    return fmt::format(
        "The record has no setpoints, and those of the study are not the ones of {}: name their columns "
        "(data.setpoint).",
        fmt::join(names, ", "));
  }
  if (!check.is_closed_loop)
    return "No MV responds to the CVs: this looks like an open-loop test.";
  const Eigen::Index mv = check.worst_mv();
  constexpr double kSteadyPull = 1.0;  // standard deviations
  if (mv >= 0 && of.study.controller.has_targets() && std::abs(check.pull(mv)) > kSteadyPull)
    return fmt::format(
        "It pulls {} {} throughout: look at the costs of the target optimizer "
        "(controller.mv.NAME.cost) and at the limits.",
        mv_name(of.study, mv), check.pull(mv) > 0.0 ? "up" : "down");
  return "Look at its tuning, setpoints and limits.";
}

}  // namespace

double number_of_cv(const AssessmentRecord& said, std::string_view name, Eigen::Index row) {
  const Eigen::MatrixXd values = said.values(name);
  return row < values.rows() && values.cols() == 1 ? values(row, 0) : kNaN;
}

FaultSource source_of_cv(const AssessmentRecord& said, Eigen::Index cv) {
  const double source = number_of_cv(said, "cv_source", cv);
  return number_of_cv(said, "cv_flagged", cv) != 1.0 || std::isnan(source) ? FaultSource::none
                                                                           : static_cast<FaultSource>(source);
}

std::vector<std::string> named_mvs(const Study& study, const AssessmentRecord& said, Eigen::Index cv) {
  const Eigen::MatrixXd channels = said.values("channel_flagged");
  std::vector<std::string> mvs;
  for (Eigen::Index mv = 0; cv < channels.rows() && mv < channels.cols(); ++mv)
    if (channels(cv, mv) == 1.0)
      mvs.push_back(mv_name(study, mv));
  return mvs;
}

std::string named_candidate(const RecordAssessment& assessment, const AssessmentRecord& said,
                            Eigen::Index cv) {
  const double candidate = number_of_cv(said, "candidate", cv);
  return number_of_cv(said, "cv_flagged", cv) != 1.0 || std::isnan(candidate)
             ? ""
             : assessment.record.candidate_names[static_cast<std::size_t>(candidate)];
}

std::string window_text(const RecordAssessment& assessment, int window) {
  const MonitoringOptions& monitoring = *assessment.study.monitoring;
  const auto stamp = [&](int sample) { return assessment.record.stamps[static_cast<std::size_t>(sample)]; };
  return fmt::format("{} to {}", stamp(monitoring.begin(window)), stamp(monitoring.end(window) - 1));
}

std::vector<std::string> controller_sentences(const RecordAssessment& of) {
  const ControllerCheck& check = of.controller;
  if (check.is_alike())
    return {};
  const Eigen::Index mv = check.worst_mv();
  return {
      check.failure.empty()
          ? fmt::format("With these measurements, the controller of the study would have moved {} "
                        "differently (agreement {:.2f}; the controller that ran would have 1).",
                        mv_name(of.study, mv), check.agreement(mv))
          : fmt::format("The controller of the study does not run on these measurements: {}.", check.failure),
      difference_sentence(of)};
}

std::string stuck_mv(const Study& study, const AssessmentRecord& said) {
  const double mv = said.number("valve_mv");
  return std::isnan(mv) ? "" : mv_name(study, static_cast<Eigen::Index>(mv));
}

std::string source_words(const Study& study, const AssessmentRecord& said, FaultSource source) {
  if (source == FaultSource::none)
    return "-";
  const std::string mv = source == FaultSource::other ? stuck_mv(study, said) : "";
  return mv.empty() ? source_name(source) : fmt::format("valve of {}", mv);
}

std::vector<std::string> worsened_by_repair(const RecordAssessment& of) {
  return worsened_cvs(of.study, of.repair->now, of.repair->predicted, of.named_prospect());
}

AssessmentText assessment_text(const RecordAssessment& of) {
  AssessmentText text{.verdict = record_verdict_text(of.verdict, of.study, of.record.stamps)};
  for (std::string& sentence : controller_sentences(of))
    text.further.push_back(std::move(sentence));
  add_candidates(of, text.further);
  add_trust(of, text.trust);
  add_repair(of, text.repair);
  return text;
}

std::vector<std::string> verdict_sentences(const RecordAssessment& assessment) {
  const AssessmentText text = assessment_text(assessment);
  Texts sentences{text.verdict.model, text.verdict.loop, text.verdict.action, text.verdict.benchmark};
  for (const Texts* const more : {&text.further, &text.trust})
    sentences.insert(sentences.end(), more->begin(), more->end());
  return sentences;
}

std::string brief_text(const RecordAssessment& of) {
  const AssessmentText text = assessment_text(of);
  std::string lines =
      fmt::format("{}: {}, {} to {}\n\nModel:  {}\nLoop:   {}\nAction: {}\nBasis:  {}\n",
                  of.study.plant.title, of.file, of.record.stamps.front(), of.record.stamps.back(),
                  text.verdict.model, text.verdict.loop, text.verdict.action, text.verdict.benchmark);
  if (!text.verdict.probabilities.empty())
    lines += "\n" + text.verdict.probabilities + "\n";
  if (!of.warnings.empty())
    lines += fmt::format("{}: see the page.\n", counted(std::ssize(of.warnings), "warning"));
  return lines;
}

}  // namespace mpm
