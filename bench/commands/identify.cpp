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

#include "analysis/study_files/identified_model.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

struct IdentifyArguments {
  std::string study;
  std::vector<std::string> steps;  ///< "NAME=SIZE"
  std::string step_response;       ///< file to write; empty: none
  int samples = 0;                 ///< 0: as many as the step responses of T0 have
  bool noise = false;
  bool json = false;
  bool quiet = false;
};

/// The steps of all inputs: from "NAME=SIZE" if the user gives it, otherwise the usual step.
Eigen::VectorXd step_sizes(const Study& study, const std::vector<std::string>& said) {
  const std::vector<std::string> names = input_names(study.plant);
  Eigen::VectorXd sizes = usual_steps(study);
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

Json list_of_numbers(const Eigen::VectorXd& vector) {
  return std::vector<double>(vector.begin(), vector.end());
}

/// A channel as JSON, with all digits of its numbers.
Json channel_json(const IdentifiedChannel& channel) {
  const TransferFunction& G = channel.fit.channel;
  return {{"cv", channel.cv},
          {"input", channel.input},
          {G.is_integrating() ? "rate_gain" : "gain", G.is_integrating() ? G.rate_gain() : G.static_gain()},
          {"numerator", list_of_numbers(G.numerator())},
          {"denominator", list_of_numbers(G.denominator())},
          {"dead_time", G.dead_time()},
          {"explained", channel.fit.explained},
          {"rms_error", channel.rms_error},
          {"asymmetry", channel.asymmetry},
          {"warning", channel.doubt.empty() ? Json() : Json(channel.doubt)}};
}

std::string model_json(const Study& study, const IdentifiedModel& model) {
  Json json{{"plant", study.plant.name},
            {"time_unit", study.plant.time_unit},
            {"sample_time", study.controller.sample_time},
            {"samples", model.test.samples},
            {"noise", model.test.noise},
            {"steps", Json::object()},
            {"channels", Json::array()}};
  const std::vector<std::string> names = input_names(study.plant);
  for (std::size_t i = 0; i < names.size(); ++i)
    json["steps"][names[i]] = model.test.sizes(static_cast<Eigen::Index>(i));
  for (const IdentifiedChannel& channel : model.channels)
    json["channels"].push_back(channel_json(channel));
  return json_text(json);
}

ExitCode identify(const IdentifyArguments& arguments) {
  Progress progress(arguments.quiet);
  const Study study = find_study(arguments.study);
  const IdentifiedModel model = identified_model(
      study, {.sizes = step_sizes(study, arguments.steps),
              .samples = arguments.samples > 0 ? arguments.samples : study.sensitivity.samples,
              .noise = arguments.noise});
  if (!arguments.step_response.empty())
    write_text(arguments.step_response, step_response_csv(study, model));
  for (const std::string& text : model.warnings(study))
    progress.note("warning: " + text);
  print_result((arguments.json ? model_json : model_toml)(study, model));
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
