#include "results/assess/assessment_sentences.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/repair_form.hpp"
#include "results/text/experiment_heading.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

using Texts = std::vector<std::string>;

std::string share_text(const Rate& rate) {
  return fmt::format("{:.0f} % [{:.0f}, {:.0f}]", 100.0 * rate.value, 100.0 * rate.interval.lower,
                     100.0 * rate.interval.upper);
}

/// "xD 2.31, xB 1.02" times the nominal loop, of methods that say so.
std::string costs_text(const RecordAssessment& of) {
  Texts parts;
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv)
    if (const double ivar = number_of_cv(of.verdict(), "ivar", cv); !std::isnan(ivar))
      parts.push_back(fmt::format("{} x {:.2f}", cv_name(of.study, cv), ivar));
  return parts.empty() ? "" : fmt::format(" (variance against the nominal loop: {})", fmt::join(parts, ", "));
}

std::string flag_sentence(const RecordAssessment& of) {
  const std::string& name = of.verdict().form->method().name;
  switch (of.found()) {
    case RecordVerdict::none:
      return fmt::format("No verdict: {} says nothing of this record: {}.", name, of.verdict().reason);
    case RecordVerdict::nothing:
      return fmt::format("{} finds nothing in this record that is worth a repair{}.", name, costs_text(of));
    case RecordVerdict::other_controller:
      return fmt::format(
          "Nothing is wrong with the model: it explains the record. The controller in the study "
          "is not the one that ran{}.",
          costs_text(of));
    case RecordVerdict::unexplained_cost:
      return fmt::format(
          "Nothing is wrong with the model: it explains the record. Only the variances are not those of the "
          "nominal loop{}.",
          costs_text(of));
    case RecordVerdict::fault:
      break;
  }
  return fmt::format("Something is wrong with this loop, says {}{}.", name, costs_text(of));
}

void add_unexplained(const RecordAssessment& of, Texts& sentences) {
  for (const UnexplainedCv& each : of.unexplained)
    sentences.push_back(fmt::format(
        "The model does not explain {}: its noise is {:.2g} times that of the study, and the "
        "model leaves more than half of what it does. Look at its sensor, and at the noise of the study "
        "(simulation.noise_standard_deviation).",
        cv_name(of.study, each.cv), each.noise));
}

/// The mismatch without its size where the repair beside it identifies that again: one record, one number.
NamedMismatch told_once(const RecordAssessment& of, NamedMismatch named) {
  if (of.repair && !of.repair->repair.named)
    named.size = named.lower = named.upper = kNaN;
  return named;
}

/// In whole percent; no probability that is computed under a list of hypotheses is 0 or 100 %.
std::string probability_text(double probability) {
  return probability > 0.99   ? "more than 99 %"
         : probability < 0.01 ? "less than 1 %"
                              : fmt::format("{:.0f} %", 100.0 * probability);
}

/// How probable mismatch, disturbance and valve are, given a fault.
void add_odds(const RecordAssessment& of, Texts& sentences) {
  const std::optional<FaultOdds> odds = of.fault_odds();
  if (!odds)
    return;
  const std::string valve = odds->other < 0.005
                                ? ""
                                : fmt::format(", a valve that sticks ({}) with {}",
                                              stuck_mv(of.study, of.odds), probability_text(odds->other));
  sentences.push_back(fmt::format(
      "Given a fault, the likelihood sees a mismatch with a probability of {}, a disturbance with {}{}{}.",
      probability_text(odds->mpm + odds->mpm_ud), probability_text(odds->ud + odds->mpm_ud), valve,
      of.model_error > 0.0
          ? fmt::format(" (errors of the model of {:.3g} % are integrated out)", 100.0 * of.model_error)
          : std::string()));
}

void add_source(const RecordAssessment& of, Texts& sentences) {
  const AssessmentRecord& said = of.verdict();
  if (said.predicted_cv < 0)
    return;
  const std::string cv = cv_name(of.study, said.predicted_cv);
  switch (named_source(said)) {
    case FaultSource::mpm:
      sentences.push_back(fmt::format("It is at {}, and most likely the model: a model-plant mismatch.", cv));
      break;
    case FaultSource::ud:
      sentences.push_back(
          fmt::format("It is at {}, and most likely not the model: an unmeasured disturbance, which no "
                      "repair of the model takes away.",
                      cv));
      break;
    case FaultSource::mpm_ud:
      sentences.push_back(
          fmt::format("It is at {}: most likely a model-plant mismatch and an unmeasured disturbance.", cv));
      break;
    case FaultSource::other:
      if (const std::string mv = stuck_mv(of.study, said); !mv.empty()) {
        sentences.push_back(fmt::format(
            "It is at {}, and most likely neither the model nor a disturbance: the valve of {} sticks.", cv,
            mv));
        break;
      }
      sentences.push_back(fmt::format(
          "It is at {}, and it is neither the model nor a disturbance: a sensor, a valve, a limit or an "
          "operator.",
          cv));
      break;
    case FaultSource::none:
      sentences.push_back(fmt::format(
          "It is at {}; whether it is the model or a disturbance this record does not tell.", cv));
      break;
  }
  if (const auto named = said.named_mismatch())
    sentences.push_back(fmt::format("Most likely: {}.", mismatch_sentence(of.study, told_once(of, *named))));
}

/// What else than the worst CV is flagged: records of plants have more than one fault.
void add_other_cvs(const RecordAssessment& of, Texts& sentences) {
  Texts others;
  for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv)
    if (cv != of.verdict().predicted_cv && number_of_cv(of.verdict(), "cv_flagged", cv) == 1.0)
      others.push_back(
          fmt::format("{} ({})", cv_name(of.study, cv),
                      source_of_cv(of.verdict(), cv) == FaultSource::none
                          ? "source not told"
                          : source_words(of.study, of.verdict(), source_of_cv(of.verdict(), cv))));
  if (!others.empty())
    sentences.push_back(fmt::format("Flagged as well: {}.", fmt::join(others, ", ")));
}

/// The signals that a method names as inputs which the model lacks.
void add_candidates(const RecordAssessment& of, Texts& sentences) {
  Texts named;
  for (const AssessmentRecord& said : of.said)
    for (Eigen::Index cv = 0; said.answered() && cv < of.study.cv_count(); ++cv)
      if (const std::string candidate = named_candidate(of, said, cv); !candidate.empty())
        named.push_back(fmt::format("{} for {} (log10 p = {:.1f})", candidate, cv_name(of.study, cv),
                                    number_of_cv(said, "log10_p", cv)));
  if (!named.empty())
    sentences.push_back(fmt::format("Signals that the model does not know and that drive its errors: {}.",
                                    fmt::join(named, ", ")));
}

/// "take away 23 % of what the loop costs, more than 10 % with a probability of 88 %"
std::string gain_text(const RecordAssessment& of, const RepairProspect& prospect) {
  const double worth = of.study.assessment.of<AdequacyOptions>().worth;
  return fmt::format(
      "take away {:.0f} % of what the loop costs, more than {:g} % with a probability of {:.0f} %",
      100.0 * prospect.gain(), 100.0 * worth, 100.0 * prospect.probability_above(worth));
}

void add_repair(const RecordAssessment& of, Texts& sentences) {
  if (!of.no_repair.empty())
    sentences.push_back(fmt::format("What a repair would bring is not known: {}.", of.no_repair));
  if (!of.repair)
    return;
  const ChannelRepair& repair = of.repair->repair;
  const std::string name = channel_name(of.study, repair.channel);
  if (!repair.named)
    sentences.push_back(fmt::format("Identified again from this record, {} has {}.", name,
                                    correction_text(of.study, repair)));
  Texts changes;
  if (of.repair->now.size() > 0 && of.repair->predicted.size() > 0)
    for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv)
      changes.push_back(fmt::format("{} {:+.0f} %", cv_name(of.study, cv),
                                    100.0 * (of.repair->predicted(cv) / of.repair->now(cv) - 1.0)));
  sentences.push_back(
      changes.empty()
          ? fmt::format("With {} corrected in the controller the loop does not run to its end.", name)
          : fmt::format("With {} corrected in the controller the variances would change: {}.", name,
                        fmt::join(changes, ", ")));
  if (const RepairProspect* const prospect = of.named_prospect(); prospect && prospect->gain() > 0.0)
    sentences.push_back(fmt::format("This is expected to {}.", gain_text(of, *prospect)));
}

/// What to do about the channel that the verdict names.
void add_advice(const RecordAssessment& of, Texts& sentences) {
  const RepairProspect* const prospect = of.named_prospect();
  if (const Texts worse = worsened_by_repair(of); !worse.empty())
    sentences.push_back(fmt::format(
        "Do not put this channel into the controller: {} would vary more with it.", fmt::join(worse, ", ")));
  else if (prospect && !prospect->is_proposed())
    sentences.emplace_back("Leave this channel as it is: its repair is expected to take away no cost.");
  else
    sentences.emplace_back("Test this channel on the plant, and put it into the model if the test agrees.");
}

/// The channel whose repair brings most, where that is not the one that the verdict names and is worth it.
void add_best_prospect(const RecordAssessment& of, Texts& sentences) {
  const auto& options = of.study.assessment.of<AdequacyOptions>();
  const auto best = std::find_if(of.prospects.begin(), of.prospects.end(),
                                 [](const RepairProspect& prospect) { return prospect.is_proposed(); });
  if (best != of.prospects.end() && &*best != of.named_prospect() &&
      best->probability_above(options.worth) > options.probability)
    sentences.push_back(
        fmt::format("Of all repairs that worsen no CV, that of {} would bring most: it is expected to {}.",
                    channel_name(of.study, best->repair.channel), gain_text(of, *best)));
}

/// "2.31, and the threshold 0.85: 3 of 100 simulated records without a fault score as high".
std::string score_text(const AssessmentRecord& said, const TrialFindings& found) {
  return fmt::format(
      "{:.3g}, and the threshold {:.3g}: {} of {} simulated records without a fault score as "
      "high",
      said.score, found.threshold, found.as_high.hits, found.as_high.total);
}

/// What the simulated records have in common with this one.
std::string worlds_text(const RecordAssessment& of) {
  return of.model_error > 0.0
             ? fmt::format("models that are {:.3g} % off in every channel", 100.0 * of.model_error)
             : std::string("an exact model");
}

void add_trust(const RecordAssessment& of, Texts& sentences) {
  if (!of.trial) {
    sentences.push_back(fmt::format("How far to trust this is not known: {}.", of.no_trial));
    return;
  }
  const TrialFindings& found = of.trial->methods.front();
  const MethodRates& rates = found.rates;
  const std::string& name = of.verdict().form->method().name;
  if (of.model.answered() && of.model_error > 0.0)
    sentences.push_back(
        fmt::format("The score of the simulation errors is {}. A fault is named above it only.",
                    score_text(of.model, of.trial->model)));
  if (of.verdict().answered())
    sentences.push_back(fmt::format("The score of {} is {}.", name, score_text(of.verdict(), found)));
  std::string text = fmt::format(
      "Of {} simulated records like this one, with {}, {} flagged {} of those without a fault and {} of "
      "those "
      "with one ({} where it had an impact)",
      of.trial->loops, worlds_text(of), name, share_text(rates["false_alarm_healthy"]),
      share_text(rates["detected"]), share_text(rates["detected_impact"]));
  if (rates["source"].total > 0)
    text += fmt::format("; of one fault alone it named the right source in {}", share_text(rates["source"]));
  if (rates["located"].total > 0)
    text += fmt::format(", the right CV in {}", share_text(rates["located"]));
  sentences.push_back(text + ".");
  if (of.found() == RecordVerdict::fault && found.same_source.total > 0)
    sentences.push_back(
        fmt::format("Of the simulated records of which it said the same of the source, it was right in {}.",
                    share_text(found.same_source)));
}

void add_to_do(const RecordAssessment& of, Texts& sentences) {
  switch (of.found()) {
    case RecordVerdict::none:
    case RecordVerdict::nothing:
      sentences.emplace_back(of.warnings.empty() ? "Nothing." : "Look at the warnings; otherwise nothing.");
      return;
    case RecordVerdict::other_controller:
      sentences.emplace_back(
          "Bring the controller of the study to what ran (setpoints, limits, costs, tuning), and assess "
          "again; "
          "leave the model as it is.");
      return;
    case RecordVerdict::unexplained_cost:
      sentences.emplace_back(
          "Look at tuning, setpoints, limits and the operating point of that time; leave the model as it "
          "is.");
      return;
    case RecordVerdict::fault:
      break;
  }
  add_repair(of, sentences);
  if (of.repair && of.information)
    sentences.push_back(information_sentence(of.study, of.repair->repair.channel, *of.information));
  if (of.repair)
    add_advice(of, sentences);
  add_best_prospect(of, sentences);
  if (of.repair)
    return;
  const FaultSource source = named_source(of.verdict());
  const std::string mv = stuck_mv(of.study, of.verdict());
  if (source == FaultSource::ud)
    sentences.push_back(fmt::format("Look for what disturbs {} from outside of the loop.",
                                    cv_name(of.study, of.verdict().predicted_cv)));
  else if (source == FaultSource::other)
    sentences.push_back(
        mv.empty()
            ? "Look at sensors, valves, limits and operators of that time before the model."
            : fmt::format("Check the valve of {} and its positioner before the model: move it in small "
                          "steps, and see from which size on the plant answers.",
                          mv));
}

/// By what the controller that ran may differ.
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
    return "No MV answers the CVs: this looks like an open-loop test.";
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

std::string mismatch_sentence(const Study& study, const NamedMismatch& named) {
  const std::string channel =
      fmt::format("{}/{}", cv_name(study, named.channel.cv), mv_name(study, named.channel.mv));
  const bool has_size = !std::isnan(named.size);
  const std::string size = estimate_text(named.size, named.lower, named.upper, named.bound);
  const std::string times =
      has_size ? fmt::format("{} times that of the model", size) : "not that of the model";
  const std::string& unit = study.plant.time_unit;
  switch (named.parameter) {
    case MismatchParameter::gain:
      return fmt::format("the gain of {} in the plant is {}", channel, times);
    case MismatchParameter::time_constant:
      return fmt::format("the time constant of {} in the plant is {}", channel, times);
    case MismatchParameter::dead_time:
      return fmt::format("the dead time of {} in the plant is {}", channel,
                         has_size ? dead_time_text(named.size, named.lower, named.upper, named.bound, unit)
                                  : "not that of the model");
    case MismatchParameter::second_order:
      return fmt::format("{} has a further lag{}", channel,
                         has_size ? fmt::format(" of {} {}", size, unit) : "");
    case MismatchParameter::inverse_response:
      return fmt::format("{} has an inverse response{}", channel,
                         has_size ? fmt::format(" of {} {}", size, unit) : "");
    case MismatchParameter::sign:
      return fmt::format("the gain of {} has the other sign in the plant", channel);
    case MismatchParameter::channel:
      break;
  }
  return fmt::format("{} differs from the model", channel);
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
          ? fmt::format("On what was measured, the controller of the study would have moved {} otherwise "
                        "(agreement {:.2f}, and 1 if it had run).",
                        mv_name(of.study, mv), check.agreement(mv))
          : fmt::format("The controller of the study does not run on what was measured: {}.", check.failure),
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

AssessmentText verdict_text(const RecordAssessment& of) {
  AssessmentText text;
  text.asked.push_back(
      fmt::format("Does the model of {} still explain what {} shows, and does its loop run as "
                  "designed?",
                  of.study.plant.title, of.file));
  text.found.push_back(flag_sentence(of));
  add_unexplained(of, text.found);
  if (of.found() == RecordVerdict::fault) {
    add_source(of, text.found);
    add_other_cvs(of, text.found);
  }
  for (std::string& sentence : controller_sentences(of))
    text.found.push_back(std::move(sentence));
  add_candidates(of, text.found);
  add_to_do(of, text.to_do);
  add_odds(of, text.sure);
  add_trust(of, text.sure);
  return text;
}

std::vector<std::string> verdict_sentences(const RecordAssessment& assessment) {
  const AssessmentText text = verdict_text(assessment);
  Texts sentences = text.found;
  sentences.insert(sentences.end(), text.to_do.begin(), text.to_do.end());
  sentences.insert(sentences.end(), text.sure.begin(), text.sure.end());
  return sentences;
}

}  // namespace mpm
