#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/experiment/judgement.hpp"
#include "results/assess/record_assessment.hpp"
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
  if (!of.verdict().answered())
    return fmt::format("No verdict: {} says nothing of this record: {}.", name, of.verdict().reason);
  return of.verdict().flagged
             ? fmt::format("Something is wrong with this loop, says {}{}.", name, costs_text(of))
             : fmt::format("{} finds nothing in this record that is worth a repair{}.", name, costs_text(of));
}

/// The mismatch without its size where the repair beside it says that: the same record gives one number.
NamedMismatch told_once(const RecordAssessment& of, NamedMismatch named) {
  if (of.repair && of.repair->only && *of.repair->only == named.parameter &&
      of.repair->channel == named.channel)
    named.size = named.lower = named.upper = kNaN;
  return named;
}

void add_source(const RecordAssessment& of, Texts& sentences) {
  const AssessmentRecord& said = of.verdict();
  if (said.predicted_cv < 0)
    return;
  const std::string cv = cv_name(of.study, said.predicted_cv);
  switch (named_source(said)) {
    case FaultSource::mpm:
      sentences.push_back(fmt::format("It is at {}, and it is the model: a model-plant mismatch.", cv));
      break;
    case FaultSource::ud:
      sentences.push_back(fmt::format(
          "It is at {}, and it is not the model: an unmeasured disturbance, which no repair of the model "
          "takes away.",
          cv));
      break;
    case FaultSource::mpm_ud:
      sentences.push_back(
          fmt::format("It is at {}: a model-plant mismatch and an unmeasured disturbance.", cv));
      break;
    case FaultSource::other:
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
      others.push_back(fmt::format("{} ({})", cv_name(of.study, cv),
                                   source_of_cv(of.verdict(), cv) == FaultSource::none
                                       ? "source not told"
                                       : source_name(source_of_cv(of.verdict(), cv))));
  if (of.verdict().flagged && !others.empty())
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

std::string number_text(const FittedNumber& number) {
  return estimate_text(number.value, number.lower, number.upper, number.bound);
}

/// What was fitted: the parameter that the verdict names, or all of the channel.
std::string fitted_text(const Study& study, const PromisedRepair& repair) {
  const ChannelFit& fit = repair.fit;
  const FittedNumber& shift = fit.dead_time_shift;
  const std::string gain = fmt::format("{} times the gain", number_text(fit.gain_factor));
  const std::string time = fmt::format("{} times the time constants", number_text(fit.time_factor));
  const std::string dead_time = "a dead time " + dead_time_text(shift.value, shift.lower, shift.upper,
                                                                shift.bound, study.plant.time_unit);
  if (!repair.only)
    return fmt::format("{}, {} and {}", gain, time, dead_time);
  const std::string& named = *repair.only == MismatchParameter::gain            ? gain
                             : *repair.only == MismatchParameter::time_constant ? time
                                                                                : dead_time;
  return named + ", all else as in the model";
}

void add_repair(const RecordAssessment& of, Texts& sentences) {
  if (!of.no_repair.empty())
    sentences.push_back(fmt::format("What a repair would bring is not known: {}.", of.no_repair));
  if (!of.repair)
    return;
  const PromisedRepair& repair = *of.repair;
  std::string text =
      fmt::format("Identified again from this record, {}/{} has {}", cv_name(of.study, repair.channel.cv),
                  mv_name(of.study, repair.channel.mv), fitted_text(of.study, repair));
  Texts changes;
  if (repair.now.size() > 0 && repair.predicted.size() > 0)
    for (Eigen::Index cv = 0; cv < of.study.cv_count(); ++cv)
      changes.push_back(fmt::format("{} {:+.0f} %", cv_name(of.study, cv),
                                    100.0 * (repair.predicted(cv) / repair.now(cv) - 1.0)));
  sentences.push_back(changes.empty()
                          ? text + "; the loop with it does not run to its end."
                          : fmt::format("{}. With it in the controller the variances would change: {}.", text,
                                        fmt::join(changes, ", ")));
}

void add_trust(const RecordAssessment& of, Texts& sentences) {
  if (!of.trial) {
    sentences.push_back(fmt::format("How far to trust this is not known: {}.", of.no_trial));
    return;
  }
  const TrialFindings& found = of.trial->methods.front();
  const MethodRates& rates = found.rates;
  std::string text = fmt::format(
      "On {} simulated loops of this controller, excitation and length, {} flagged {} of those without a "
      "fault "
      "and {} of those with one ({} where it had an impact)",
      of.trial->loops, of.verdict().form->method().name, share_text(rates.false_alarm_healthy),
      share_text(rates.detected), share_text(rates.detected_impact));
  if (rates.source.total > 0)
    text += fmt::format("; of one fault alone it named the right source in {}", share_text(rates.source));
  if (rates.located.total > 0)
    text += fmt::format(", the right CV in {}", share_text(rates.located));
  sentences.push_back(text + ".");
  if (of.verdict().answered() && of.verdict().flagged) {
    std::string record =
        fmt::format("A score as high as that of this record had {} of the {} loops without a fault",
                    found.as_high.hits, found.as_high.total);
    if (found.same_source.total > 0)
      record += fmt::format("; of the loops of which it said the same of the source, it was right in {}",
                            share_text(found.same_source));
    sentences.push_back(record + ".");
  }
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
      return fmt::format("{} has a further lag of {} {}", channel, size, unit);
    case MismatchParameter::inverse_response:
      return fmt::format("{} has an inverse response of {} {}", channel, size, unit);
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

std::vector<std::string> verdict_sentences(const RecordAssessment& assessment) {
  Texts sentences{flag_sentence(assessment)};
  if (assessment.verdict().answered() && assessment.verdict().flagged)
    add_source(assessment, sentences);
  add_other_cvs(assessment, sentences);
  add_candidates(assessment, sentences);
  add_repair(assessment, sentences);
  add_trust(assessment, sentences);
  return sentences;
}

}  // namespace mpm
