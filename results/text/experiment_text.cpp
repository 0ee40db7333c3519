#include "results/text/experiment_text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/enum_words.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {
namespace {

/// A smaller value is rounding of a search that ends at 0; no plant has such a gain factor or dead time.
constexpr double kPrintedAsZero = 1e-9;

/// "0.3 s + 2" of [0.3, 2].
std::string polynomial_text(const Eigen::VectorXd& coefficients) {
  std::string text;
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    const Eigen::Index power = coefficients.size() - 1 - i;
    if (coefficients(i) == 0 && coefficients.size() > 1)
      continue;
    text += fmt::format("{}{:.4g}{}", text.empty() ? "" : " + ", coefficients(i),
                        power == 0   ? ""
                        : power == 1 ? " s"
                                     : fmt::format(" s^{}", power));
  }
  return text;
}

std::string transfer_function_text(const TransferFunction& channel) {
  if (channel.step_coefficients())
    return fmt::format("coefficients of a step response, about {}",
                       transfer_function_text(channel.without_step_coefficients()));
  return fmt::format("({}) / ({}){}", polynomial_text(channel.numerator()),
                     polynomial_text(channel.denominator()),
                     channel.dead_time() > 0 ? fmt::format(" e^(-{:g} s)", channel.dead_time()) : "");
}

std::string input_name(const Study& study, Eigen::Index input) {
  const auto place = static_cast<std::size_t>(input);
  const std::size_t mvs = study.plant.mvs.size();
  return place < mvs ? study.plant.mvs[place].name : study.plant.mds[place - mvs].name;
}

std::string mismatch_text(const Study& study, const Mismatch& mismatch) {
  const std::string channel =
      fmt::format("{}/{}", cv_name(study, mismatch.cv), input_name(study, mismatch.input));
  const std::string time = fmt::format("{:.3g} {}", mismatch.value, unit_text(study.plant.time_unit));
  switch (mismatch.parameter) {
    case MismatchParameter::gain:
      return fmt::format("gain of {} x {:.3g}", channel, mismatch.value);
    case MismatchParameter::time_constant:
      return fmt::format("time constant of {} x {:.3g}", channel, mismatch.value);
    case MismatchParameter::dead_time:
      return fmt::format("dead time of {} {:+.3g} {}", channel, mismatch.value,
                         unit_text(study.plant.time_unit));
    case MismatchParameter::channel:
      return fmt::format("{} is {}", channel, transfer_function_text(*mismatch.channel));
    case MismatchParameter::second_order:
      return fmt::format("further lag of {} in {}", time, channel);
    case MismatchParameter::inverse_response:
      return fmt::format("inverse response of {} in {}", time, channel);
    case MismatchParameter::sign:
      return fmt::format("gain of {} has the other sign", channel);
  }
  return "unknown";
}

/// "cd1 7.86 (model 3.145)"
std::string parameter_text(const Study& study, const ParameterChange& change) {
  for (const NonlinearModel::Parameter& parameter : study.nonlinear->model.parameters)
    if (parameter.name == change.name)
      return fmt::format("{} {:.4g} (model {:.4g})", change.name, change.value, parameter.nominal);
  return fmt::format("{} {:.4g}", change.name, change.value);
}

std::string place_text(const Study& study, const Disturbance& disturbance) {
  if (disturbance.mv)
    return mv_name(study, *disturbance.mv);
  return disturbance.inner_input
             ? study.nonlinear->model.inner_inputs[static_cast<std::size_t>(*disturbance.inner_input)]
             : cv_name(study, disturbance.cv);
}

std::string signal_text(const Study& study, const DisturbanceSignal& signal) {
  const std::string time = unit_text(study.plant.time_unit);
  if (const auto* noise = std::get_if<WhiteNoise>(&signal)) {
    const double deviation = noise->factor * study.disturbance.v_standard_deviation;
    return fmt::format("white {:.3g}{}", deviation,
                       noise->hold > 1 ? fmt::format(" held for {} samples", noise->hold) : "");
  }
  if (const auto* sine = std::get_if<Sine>(&signal))
    return fmt::format("sine of amplitude {:.3g}, period {:.4g} {}", sine->amplitude, sine->period, time);
  if (const auto* ramp = std::get_if<Ramp>(&signal))
    return fmt::format("ramp of {:.3g} a {} from {:g} {}", ramp->slope, time, ramp->start, time);
  if (const auto* walk = std::get_if<RandomWalk>(&signal))
    return fmt::format("random walk of {:.3g}", walk->factor * study.disturbance.v_standard_deviation);
  if (const auto* bursts = std::get_if<Bursts>(&signal))
    return fmt::format("bursts of {:.3g}", bursts->factor * study.disturbance.v_standard_deviation);
  return counted(std::ssize(std::get<StepSequence>(signal).steps), "step");
}

/// Leaves out the signal of a random disturbance if it is white.
std::string disturbance_text(const Study& study, const Disturbance& disturbance, bool named) {
  const std::string on = "disturbance on " + place_text(study, disturbance);
  const bool worth_saying = named || !std::holds_alternative<WhiteNoise>(disturbance.signal);
  const std::string signal = worth_saying ? fmt::format(", {}", signal_text(study, disturbance.signal)) : "";
  switch (disturbance.model) {
    case DisturbanceModel::first_order:
      return fmt::format("{}: gain {:.3g}, time constant {:.3g} {}{}", on, disturbance.gain,
                         disturbance.time_constant, unit_text(study.plant.time_unit), signal);
    case DisturbanceModel::transfer_function:
      return fmt::format("{}: {}{}", on, transfer_function_text(*disturbance.Gd), signal);
    case DisturbanceModel::direct:
      return fmt::format("{}: {}", on, signal_text(study, disturbance.signal));
  }
  return "unknown";
}

/// "move suppression of u2 x 0.3"
std::string tuning_text(const Study& study, const TuningChange& tuning) {
  std::string weight(to_string(tuning.parameter));
  std::replace(weight.begin(), weight.end(), '_', ' ');
  const auto& variables = is_of_mv(tuning.parameter) ? study.plant.mvs : study.plant.cvs;
  return fmt::format("{} of {} x {:.3g}", weight, variables[static_cast<std::size_t>(tuning.index)].name,
                     tuning.factor);
}

/// "stiction of u2: 0.05"
std::string other_text(const Study& study, const OtherFault& fault) {
  std::string kind(to_string(fault.kind));
  std::replace(kind.begin(), kind.end(), '_', ' ');
  const VariableSort sort = info_of(fault.kind).sort;
  const auto& variables = sort == VariableSort::cv   ? study.plant.cvs
                          : sort == VariableSort::mv ? study.plant.mvs
                                                     : study.plant.mds;
  const std::string& name = variables[static_cast<std::size_t>(fault.variable)].name;
  return std::isnan(fault.size) ? fmt::format("{}: {}", kind, name)
                                : fmt::format("{} of {}: {:.3g}", kind, name, fault.size);
}

std::string onset_text(const Onset& onset) {
  return onset.growth == 0 ? fmt::format("from sample {}", onset.sample)
                           : fmt::format("from sample {} to {}", onset.sample, onset.sample + onset.growth);
}

}  // namespace

std::string whose_intervals(bool in_worlds) {
  return in_worlds ? "Intervals hold for randomly drawn worlds: the loops of one world share its model "
                     "errors and its benchmark."
                   : "Intervals hold for the one benchmark from which the methods of this study have learnt. "
                     "Over 14 benchmarks, the number of false alarms of sse, likelihood and arx-oe, and "
                     "under coloured noise, had 3 to 6 times the variance of a binomial number.";
}

std::string counted(std::int64_t count, const std::string& thing, const std::string& things) {
  return fmt::format("{} {}", count, count == 1 ? thing : things.empty() ? thing + "s" : things);
}

std::string failures_text(const VerdictFailures& failures) {
  return fmt::format("failed on {} of the {} on which it was asked, first with: {}", failures.failed,
                     counted(failures.asked, "loop"), failures.reason);
}

std::string kind_name(ExperimentKind kind) {
  switch (kind) {
    case ExperimentKind::healthy:
      return "healthy";
    case ExperimentKind::tuning:
      return "tuning";
    case ExperimentKind::mpm:
    case ExperimentKind::ud:
    case ExperimentKind::mpm_ud:
    case ExperimentKind::other:
      return source_name(source_of(kind));
  }
  return "unknown";
}

std::string source_name(FaultSource source) {
  constexpr auto kNames = word_list("none", "MPM", "UD", "MPM+UD", "other");
  return std::string(kNames.at(static_cast<std::size_t>(source)));
}

std::string cv_name(const Study& study, Eigen::Index cv) {
  return cv < 0 ? "none" : study.plant.cvs[static_cast<std::size_t>(cv)].name;
}

std::string mv_name(const Study& study, Eigen::Index mv) {
  return study.plant.mvs[static_cast<std::size_t>(mv)].name;
}

std::string fault_text(const Study& study, const ExperimentDraw& draw) {
  std::string text;
  const auto add = [&text](const std::string& fault) { text += (text.empty() ? "" : "; ") + fault; };
  for (const Mismatch& mismatch : draw.mismatches)
    add(mismatch_text(study, mismatch));
  for (const ParameterChange& change : draw.parameters)
    add(parameter_text(study, change));
  for (const Disturbance& disturbance : draw.disturbances)
    add(disturbance_text(study, disturbance, draw.named));
  if (draw.tuning)
    add(tuning_text(study, *draw.tuning));
  if (draw.other)
    add(other_text(study, *draw.other));
  if (!draw.onset.from_the_start())
    add(onset_text(draw.onset));
  return text.empty() ? "nothing" : text;
}

std::string experiment_title(const Study& study, const ExperimentDraw& draw) {
  if (draw.named)
    return fmt::format("{} ({}): {}", study.scenarios[static_cast<std::size_t>(draw.index)].name,
                       kind_name(draw.kind), fault_text(study, draw));
  return fmt::format("experiment {} ({}): {}", draw.index, kind_name(draw.kind), fault_text(study, draw));
}

std::string estimate_text(double value, double lower, double upper, SizeBound bound) {
  const auto number = [](double of) {
    return fmt::format("{:.3g}", std::abs(of) < kPrintedAsZero ? 0.0 : of);
  };
  if (bound != SizeBound::none) {
    const double end = bound == SizeBound::at_least ? lower : upper;
    return fmt::format("{} {}", to_string(bound), number(std::isnan(end) ? value : end));
  }
  return number(value) + (std::isnan(lower) ? "" : fmt::format(" ({} to {})", number(lower), number(upper)));
}

std::string dead_time_text(double shift, double lower, double upper, SizeBound bound,
                           const std::string& unit) {
  const bool shorter = shift < -kPrintedAsZero;
  if (shorter) {  // the same, as the size of the reduction
    shift = -shift;
    std::swap(lower, upper);
    lower = -lower;
    upper = -upper;
    bound = bound == SizeBound::at_most    ? SizeBound::at_least
            : bound == SizeBound::at_least ? SizeBound::at_most
                                           : SizeBound::none;
  }
  return fmt::format("{} by {} {}", shorter ? "shorter" : "longer", estimate_text(shift, lower, upper, bound),
                     unit);
}

std::string conditions_text(const ExperimentRecord& record) {
  const LoopConditions& conditions = record.conditions;
  std::string text;
  if (const std::optional<bool> stable = conditions.stable())
    text = fmt::format("loop {} (spectral radius {:.4g})", *stable ? "stable" : "unstable",
                       conditions.spectral_radius);
  if (!std::isnan(conditions.other_cv_active) && !std::isnan(conditions.mv_at_limit))
    text += fmt::format("{}another CV at a limit in {:.0f} % of the samples, an MV in {:.0f} %",
                        text.empty() ? "" : "; ", 100.0 * conditions.other_cv_active,
                        100.0 * conditions.mv_at_limit);
  return text;
}

}  // namespace mpm
