#include "analysis/study_files/identified_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/toml_literal.hpp"

namespace mpm {
namespace {

constexpr double kShareOfRange = 0.02;    // usual step of an MV, as a share of its hard range
constexpr double kNegligibleMove = 1e-8;  // in the unit of a CV: only an error of integration
constexpr double kUnfinished = 0.05;      // of the gain: the response has not ended
constexpr double kPoorFit = 0.99;         // explained share below which there is a warning

std::vector<PlantModel::Variable> all_inputs(const PlantModel& plant) {
  std::vector<PlantModel::Variable> inputs = plant.mvs;
  inputs.insert(inputs.end(), plant.mds.begin(), plant.mds.end());
  return inputs;
}

double usual_step(const Study& study, Eigen::Index input) {
  if (input < study.mv_count()) {
    const double range = study.controller.mv_hard.upper(input) - study.controller.mv_hard.lower(input);
    return std::isfinite(range) && range > 0.0 ? kShareOfRange * range : kNaN;
  }
  const Distribution& random = study.simulation.step_level;
  double largest =
      study.simulation.random_steps ? std::max(std::abs(random.minimum()), std::abs(random.maximum())) : 0.0;
  for (const SignalStep& step : study.simulation.steps)
    if (step.variable == input - study.mv_count())
      largest = std::max(largest, std::abs(step.level));
  return largest > 0.0 ? largest : kNaN;
}

/// Returns the reason to doubt a model of this response; empty if there is none.
std::string doubt_of(const StepResponseFit& fit, const Eigen::VectorXd& response, double sample_time) {
  if (fit.explained < kPoorFit)
    return fmt::format("only {:.1f} % of the step response is explained", 100.0 * fit.explained);
  const ResponseEnd end = response_end(fit.channel, response, sample_time);
  if (std::abs(end.last - end.fitted) > kUnfinished * std::abs(end.fitted))
    return fmt::format("the response ends at {}{:.3g} while the model goes on to {:.3g}: use more --samples",
                       fit.channel.is_integrating() ? "a rate of " : "", end.last, end.fitted);
  return "";
}

std::vector<IdentifiedChannel> identified_channels(const Study& study, const IdentifiedModel& model) {
  const std::vector<std::string> inputs = input_names(study.plant);
  const double sample_time = study.controller.sample_time;
  std::vector<IdentifiedChannel> channels;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (std::size_t input = 0; input < inputs.size(); ++input) {
      const StepResponse& of_input = model.responses[input];
      const double size = model.test.sizes(static_cast<Eigen::Index>(input));
      const Eigen::VectorXd response = of_input.response.row(cv).transpose();
      const StepResponseFit fit = fit_step_response(response, sample_time, kNegligibleMove / size);
      if (!fit.channel.is_zero())
        channels.push_back({study.plant.cvs[static_cast<std::size_t>(cv)].name, inputs[input], fit,
                            of_input.asymmetry(cv), fit.rms_error * size,
                            doubt_of(fit, response, sample_time)});
    }
  return channels;
}

/// "R 0.05 lb/min"
std::vector<std::string> step_texts(const PlantModel& plant, const Eigen::VectorXd& sizes) {
  std::vector<std::string> texts;
  for (const PlantModel::Variable& input : all_inputs(plant))
    texts.push_back(
        fmt::format("{} {:.4g} {}", input.name, sizes(static_cast<Eigen::Index>(texts.size())), input.unit));
  return texts;
}

std::string heading_text(const Study& study, const StepTestOptions& test) {
  return fmt::format(
      "# Identified from steps up and down ({}), {} samples of {} {}, {} noise.\n"
      "[plant]\nname = {}\ntitle = {}\ntime_unit = {}\n\n",
      fmt::join(step_texts(study.plant, test.sizes), "; "), test.samples, study.controller.sample_time,
      study.plant.time_unit, test.noise ? "with" : "without", toml_literal(study.plant.name),
      toml_literal(study.plant.title), toml_literal(study.plant.time_unit));
}

std::string variables_text(const char* list, const std::vector<PlantModel::Variable>& variables) {
  std::string text;
  for (const PlantModel::Variable& variable : variables) {
    text += fmt::format("[[plant.{}]]\nname = {}\nunit = {}\n", list, toml_literal(variable.name),
                        toml_literal(variable.unit));
    if (!variable.description.empty())
      text += fmt::format("description = {}\n", toml_literal(variable.description));
    text += "\n";
  }
  return text;
}

/// Writes six digits, which is more than a step test can give.
std::string coefficients_text(const Eigen::VectorXd& coefficients) {
  std::vector<std::string> texts;
  for (const double coefficient : coefficients)
    texts.push_back(fmt::format("{:.6g}", coefficient));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string channel_text(const TransferFunction& channel) {
  const bool is_simple = channel.order() == 1 && channel.numerator().size() == 1;
  std::string text =
      is_simple && channel.is_integrating() ? fmt::format("rate_gain = {:.6g}\n", channel.rate_gain())
      : is_simple ? fmt::format("gain = {:.6g}\ntime_constant = {:.6g}\n", channel.static_gain(),
                                channel.residence_time())
                  : fmt::format("numerator = {}\ndenominator = {}\n", coefficients_text(channel.numerator()),
                                coefficients_text(channel.denominator()));
  if (channel.dead_time() > 0.0)
    text += fmt::format("dead_time = {:.6g}\n", channel.dead_time());
  return text;
}

std::string channel_entry(const Study& study, const IdentifiedChannel& channel) {
  const auto cv = std::find_if(study.plant.cvs.begin(), study.plant.cvs.end(),
                               [&](const PlantModel::Variable& each) { return each.name == channel.cv; });
  return fmt::format(
      "# {:.3f} % explained, error {:.2g} {} rms under this step; asymmetry of up and down {:.2g}\n"
      "[[plant.channel]]\ncv = {}\ninput = {}\n{}\n",
      100.0 * channel.fit.explained, channel.rms_error, cv->unit, channel.asymmetry, toml_literal(channel.cv),
      toml_literal(channel.input), channel_text(channel.fit.channel));
}

}  // namespace

std::vector<std::string> IdentifiedModel::warnings(const Study& study) const {
  std::vector<std::string> sentences;
  const auto none_has = [this](std::string IdentifiedChannel::*end, const std::string& name) {
    return std::none_of(channels.begin(), channels.end(),
                        [&](const IdentifiedChannel& channel) { return channel.*end == name; });
  };
  for (const PlantModel::Variable& cv : study.plant.cvs)
    if (none_has(&IdentifiedChannel::cv, cv.name))
      sentences.push_back(fmt::format("no step moves {}, so it has no channel", cv.name));
  for (const std::string& input : input_names(study.plant))
    if (none_has(&IdentifiedChannel::input, input))
      sentences.push_back(fmt::format("the step of {} moves no CV: use a larger step (--step)", input));
  for (const IdentifiedChannel& channel : channels)
    if (!channel.doubt.empty())
      sentences.push_back(fmt::format("{} to {}: {}", channel.input, channel.cv, channel.doubt));
  return sentences;
}

Eigen::VectorXd usual_steps(const Study& study) {
  Eigen::VectorXd sizes(study.mv_count() + std::ssize(study.plant.mds));
  for (Eigen::Index input = 0; input < sizes.size(); ++input)
    sizes(input) = usual_step(study, input);
  return sizes;
}

IdentifiedModel identified_model(const Study& study, const StepTestOptions& test) {
  IdentifiedModel model{.test = test, .responses = step_test(study, test), .channels = {}};
  model.channels = identified_channels(study, model);
  if (model.channels.empty())
    throw InputError(
        "step",
        fmt::format("no channel: {} move no CV", fmt::join(step_texts(study.plant, test.sizes), ", ")),
        "steps that move a CV; use larger steps if valves stick");
  return model;
}

std::string model_toml(const Study& study, const IdentifiedModel& model) {
  std::string text = heading_text(study, model.test) + variables_text("cv", study.plant.cvs) +
                     variables_text("mv", study.plant.mvs) + variables_text("md", study.plant.mds);
  for (const IdentifiedChannel& channel : model.channels)
    text += channel_entry(study, channel);
  return text;
}

std::string step_response_csv(const Study& study, const IdentifiedModel& model) {
  std::string text = "time";
  for (const PlantModel::Variable& cv : study.plant.cvs)
    for (const std::string& input : input_names(study.plant))
      text += fmt::format(",{}/{}", cv.name, input);
  for (Eigen::Index k = 0; k < model.responses.front().response.cols(); ++k) {
    text += fmt::format("\n{}", static_cast<double>(k + 1) * study.controller.sample_time);
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
      for (const StepResponse& of_input : model.responses)
        text += fmt::format(",{}", of_input.response(cv, k));
  }
  return text + "\n";
}

}  // namespace mpm
