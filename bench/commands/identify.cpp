#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/identification/step_test.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "plants/linear/step_response_fit.hpp"
#include "results/text/number_json.hpp"
#include "scenarios/toml/toml_literal.hpp"

namespace mpm {
namespace {

constexpr double kShareOfRange = 0.02;    // of the hard limits of an MV: a step where nothing is said
constexpr double kNegligibleMove = 1e-8;  // of a CV, in its unit: what an integrator leaves
constexpr double kUnfinished = 0.05;      // of the gain: a response that is not over
constexpr double kPoorFit = 0.99;         // explained share below which a fit is warned of

struct IdentifyArguments {
  std::string study;
  std::vector<std::string> steps;  ///< "NAME=SIZE"
  std::string step_response;       ///< file to write; empty: none
  int samples = 0;                 ///< 0: those of the step responses of T0
  bool noise = false;
  bool json = false;
  bool quiet = false;
};

std::vector<PlantModel::Variable> all_inputs(const Study& study) {
  std::vector<PlantModel::Variable> inputs = study.plant.mvs;
  inputs.insert(inputs.end(), study.plant.mds.begin(), study.plant.mds.end());
  return inputs;
}

/// The step of an input where the command line does not say it; NaN where nothing else does.
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

/// The steps of all inputs, from "NAME=SIZE" where it is said.
Eigen::VectorXd step_sizes(const Study& study, const std::vector<std::string>& said) {
  const std::vector<PlantModel::Variable> inputs = all_inputs(study);
  std::vector<std::string> names;
  for (const PlantModel::Variable& input : inputs)
    names.push_back(input.name);
  Eigen::VectorXd sizes(static_cast<Eigen::Index>(inputs.size()));
  for (Eigen::Index input = 0; input < sizes.size(); ++input)
    sizes(input) = usual_step(study, input);
  for (const std::string& text : said) {
    const std::size_t equals = text.find('=');
    const auto named = std::find(names.begin(), names.end(), text.substr(0, equals));
    double size = kNaN;
    if (equals != std::string::npos && named != names.end() &&
        CLI::detail::lexical_cast(text.substr(equals + 1), size) && size > 0.0 && std::isfinite(size))
      sizes(named - names.begin()) = size;
    else
      throw InputError("--step", fmt::format("'{}'", text),
                       fmt::format("NAME=SIZE with a size > 0, of {}", fmt::join(names, ", ")));
  }
  for (Eigen::Index input = 0; input < sizes.size(); ++input)
    if (std::isnan(sizes(input)))
      throw InputError("--step", fmt::format("no size for '{}'", names[static_cast<std::size_t>(input)]),
                       "NAME=SIZE for an MV without hard limits and for an MD that the study does not step");
  return sizes;
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

/// Six digits: more than a step test gives.
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

/// What speaks against a model of this response; empty: nothing.
std::string doubt_of(const StepResponseFit& fit, const Eigen::VectorXd& response, double sample_time) {
  if (fit.explained < kPoorFit)
    return fmt::format("only {:.1f} % of the step response is explained", 100.0 * fit.explained);
  const ResponseEnd end = response_end(fit.channel, response, sample_time);
  if (std::abs(end.last - end.fitted) > kUnfinished * std::abs(end.fitted))
    return fmt::format("the response ends at {}{:.3g} while the model goes on to {:.3g}: use more --samples",
                       fit.channel.is_integrating() ? "a rate of " : "", end.last, end.fitted);
  return "";
}

std::string heading_text(const Study& study, const Eigen::VectorXd& sizes, const IdentifyArguments& arguments,
                         int samples) {
  const std::vector<PlantModel::Variable> inputs = all_inputs(study);
  std::vector<std::string> steps;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    steps.push_back(
        fmt::format("{} {:.4g} {}", inputs[i].name, sizes(static_cast<Eigen::Index>(i)), inputs[i].unit));
  return fmt::format(
      "# Identified from steps up and down ({}), {} samples of {} {}, {} noise.\n"
      "[plant]\nname = {}\ntitle = {}\ntime_unit = {}\n\n",
      fmt::join(steps, "; "), samples, study.controller.sample_time, study.plant.time_unit,
      arguments.noise ? "with" : "without", toml_literal(study.plant.name), toml_literal(study.plant.title),
      toml_literal(study.plant.time_unit));
}

/// A channel as a step test gives it.
struct IdentifiedChannel {
  std::string cv, input;
  StepResponseFit fit;
  double asymmetry;   ///< of the responses up and down
  double rms_error;   ///< under the step, CV unit
  std::string unit;   ///< of the CV
  std::string doubt;  ///< what speaks against it; empty: nothing
};

/// The channels that are not zero, CV by CV.
std::vector<IdentifiedChannel> identified_channels(const Study& study,
                                                   const std::vector<StepResponse>& responses,
                                                   const Eigen::VectorXd& sizes) {
  const std::vector<PlantModel::Variable> inputs = all_inputs(study);
  std::vector<IdentifiedChannel> channels;
  for (std::size_t cv = 0; cv < study.plant.cvs.size(); ++cv)
    for (std::size_t input = 0; input < inputs.size(); ++input) {
      const auto row = static_cast<Eigen::Index>(cv);
      const double size = sizes(static_cast<Eigen::Index>(input));
      const Eigen::MatrixXd& response = responses[input].response;
      const StepResponseFit fit = fit_step_response(response.row(row).transpose(),
                                                    study.controller.sample_time, kNegligibleMove / size);
      if (!fit.channel.is_zero())
        channels.push_back({study.plant.cvs[cv].name, inputs[input].name, fit,
                            responses[input].asymmetry(row), fit.rms_error * size, study.plant.cvs[cv].unit,
                            doubt_of(fit, response.row(row).transpose(), study.controller.sample_time)});
    }
  return channels;
}

/// Refuses steps that move nothing: there is no model to print.
void require_channels(const Study& study, const std::vector<IdentifiedChannel>& channels,
                      const Eigen::VectorXd& sizes) {
  if (!channels.empty())
    return;
  const std::vector<PlantModel::Variable> inputs = all_inputs(study);
  std::vector<std::string> steps;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    steps.push_back(fmt::format("{}={:.4g}", inputs[i].name, sizes(static_cast<Eigen::Index>(i))));
  throw InputError("--step", fmt::format("no channel: {} move no CV", fmt::join(steps, ", ")),
                   "steps that move a CV; use larger ones where valves stick");
}

/// A sentence for each CV that nothing moves, and for each input that moves nothing.
std::vector<std::string> unconnected(const Study& study, const std::vector<IdentifiedChannel>& channels) {
  std::vector<std::string> sentences;
  const auto none_has = [&channels](std::string IdentifiedChannel::*end, const std::string& name) {
    return std::none_of(channels.begin(), channels.end(),
                        [&](const IdentifiedChannel& channel) { return channel.*end == name; });
  };
  for (const PlantModel::Variable& cv : study.plant.cvs)
    if (none_has(&IdentifiedChannel::cv, cv.name))
      sentences.push_back(fmt::format("no step moves {}, so it has no channel", cv.name));
  for (const PlantModel::Variable& input : all_inputs(study))
    if (none_has(&IdentifiedChannel::input, input.name))
      sentences.push_back(fmt::format("the step of {} moves no CV: use a larger step (--step)", input.name));
  return sentences;
}

std::string channel_entry(const IdentifiedChannel& channel) {
  return fmt::format(
      "# {:.3f} % explained, error {:.2g} {} rms under this step; asymmetry of up and down {:.2g}\n"
      "[[plant.channel]]\ncv = {}\ninput = {}\n{}\n",
      100.0 * channel.fit.explained, channel.rms_error, channel.unit, channel.asymmetry,
      toml_literal(channel.cv), toml_literal(channel.input), channel_text(channel.fit.channel));
}

std::vector<double> list_of_numbers(const Eigen::VectorXd& vector) {
  return {vector.begin(), vector.end()};
}

/// The same with all digits.
nlohmann::ordered_json channel_json(const IdentifiedChannel& channel) {
  const TransferFunction& G = channel.fit.channel;
  return {
      {"cv", channel.cv},
      {"input", channel.input},
      {G.is_integrating() ? "rate_gain" : "gain", G.is_integrating() ? G.rate_gain() : G.static_gain()},
      {"numerator", list_of_numbers(G.numerator())},
      {"denominator", list_of_numbers(G.denominator())},
      {"dead_time", G.dead_time()},
      {"explained", channel.fit.explained},
      {"rms_error", channel.rms_error},
      {"asymmetry", channel.asymmetry},
      {"warning", channel.doubt.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(channel.doubt)}};
}

std::string model_json_text(const Study& study, const Eigen::VectorXd& sizes,
                            const IdentifyArguments& arguments, int samples,
                            const std::vector<IdentifiedChannel>& channels) {
  nlohmann::ordered_json json{{"plant", study.plant.name},
                              {"time_unit", study.plant.time_unit},
                              {"sample_time", study.controller.sample_time},
                              {"samples", samples},
                              {"noise", arguments.noise},
                              {"steps", nlohmann::ordered_json::object()},
                              {"channels", nlohmann::ordered_json::array()}};
  const std::vector<PlantModel::Variable> inputs = all_inputs(study);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    json["steps"][inputs[i].name] = sizes(static_cast<Eigen::Index>(i));
  for (const IdentifiedChannel& channel : channels)
    json["channels"].push_back(channel_json(channel));
  return json_text(json);
}

std::string model_toml_text(const Study& study, const Eigen::VectorXd& sizes,
                            const IdentifyArguments& arguments, int samples,
                            const std::vector<IdentifiedChannel>& channels) {
  std::string text = heading_text(study, sizes, arguments, samples) + variables_text("cv", study.plant.cvs) +
                     variables_text("mv", study.plant.mvs) + variables_text("md", study.plant.mds);
  for (const IdentifiedChannel& channel : channels)
    text += channel_entry(channel);
  return text;
}

/// The responses themselves, as `init --step-response` reads them.
std::string step_response_text(const Study& study, const std::vector<StepResponse>& responses) {
  const std::vector<PlantModel::Variable> inputs = all_inputs(study);
  std::string text = "time";
  for (const PlantModel::Variable& cv : study.plant.cvs)
    for (const PlantModel::Variable& input : inputs)
      text += fmt::format(",{}/{}", cv.name, input.name);
  for (Eigen::Index k = 0; k < responses.front().response.cols(); ++k) {
    text += fmt::format("\n{}", static_cast<double>(k + 1) * study.controller.sample_time);
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
      for (const StepResponse& of_input : responses)
        text += fmt::format(",{}", of_input.response(cv, k));
  }
  return text + "\n";
}

ExitCode identify(const IdentifyArguments& arguments) {
  Progress progress(arguments.quiet);
  const Study study = find_study(arguments.study);
  const Eigen::VectorXd sizes = step_sizes(study, arguments.steps);
  const int samples = arguments.samples > 0 ? arguments.samples : study.sensitivity.samples;
  const std::vector<StepResponse> responses =
      step_test(study, {.sizes = sizes, .samples = samples, .noise = arguments.noise});
  const std::vector<IdentifiedChannel> channels = identified_channels(study, responses, sizes);
  require_channels(study, channels, sizes);
  if (!arguments.step_response.empty())
    write_text(arguments.step_response, step_response_text(study, responses));
  for (const std::string& text : unconnected(study, channels))
    progress.note("warning: " + text);
  for (const IdentifiedChannel& channel : channels)
    if (!channel.doubt.empty())
      progress.note(fmt::format("warning: {} to {}: {}", channel.input, channel.cv, channel.doubt));
  print_result(
      (arguments.json ? model_json_text : model_toml_text)(study, sizes, arguments, samples, channels));
  return ExitCode::done;
}

}  // namespace

void add_identify(CommandSet& commands) {
  const auto options = std::make_shared<IdentifyArguments>();
  CLI::App& app =
      commands.add("identify", "Identify a model for the controller from steps of a study's plant",
                   [options] { return identify(*options); });
  app.add_option("STUDY", options->study, "Study file, or name of a shipped study")->required();
  app.add_option("--step", options->steps,
                 "Size of the step of an input, up and down, NAME=SIZE (default: 2 % of the range of an MV, "
                 "the largest step of an MD in the study)");
  app.add_option("--samples", options->samples,
                 "Samples of a step response (default: sensitivity.samples of the study)")
      ->check(whole_number(8, 1000000));
  add_path(
      app, "--step-response", options->step_response,
      "File to write with the step responses themselves (CSV, a column CV/INPUT for each channel), which "
      "`init --step-response` reads");
  app.add_flag("--noise", options->noise, "Add the measurement noise of the study");
  add_json(app, options->json);
  add_quiet(app, options->quiet, "No warnings");
}

}  // namespace mpm
