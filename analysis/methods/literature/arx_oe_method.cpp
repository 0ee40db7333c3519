#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/healthy_windows.hpp"
#include "analysis/methods/literature/model_comparison.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/number_rule.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "scenarios/toml/toml_table.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

/// The probability that is divided among the tests of all CVs, one of the plant and two of the noise. It is
/// not stated as the probability of a false alarm: all loops of a study share one benchmark, so more loops
/// are flagged.
constexpr double kArxOeFalseAlarms = 0.01;
constexpr double kTestsOfCv = 3.0;

enum class ArxOeForm : std::int8_t { automatic, windows, covariances };

struct ArxOeOptions {
  ArxOeForm form = ArxOeForm::automatic;
  int window = 0;  ///< samples; 0: follows from kSamplesOfCoefficient
  int step = 0;    ///< samples; 0: a quarter of a window
  double nu = 0.01, share = 0.5;

  bool operator==(const ArxOeOptions&) const = default;
};

// None of these options has a default that appears in a resolved study, so studies without them stay
// unchanged.
OptionKeys keys(ArxOeOptions& options) {
  const auto whole = [](std::string name, int& value, std::string meaning) {
    return key::option(std::move(name), "whole number", std::move(meaning), "samples")
        .allow("1 to 1000000")
        .read([&value](const TomlTable& table, const std::string& key) {
          value = static_cast<int>(read_whole(table, key, 1, 1'000'000));
        });
  };
  const auto share = [](std::string name, double& value, std::string meaning) {
    return key::option(std::move(name), "number", std::move(meaning))
        .allow("above 0, below 1")
        .otherwise(fmt::format("{}", value))
        .read([&value](const TomlTable& table, const std::string& key) {
          value = read_number(table, key, NumberRule::inside(0, 1));
        });
  };
  return {
      key::option(
          "form", "text",
          "comparison with the benchmark. `\"windows\"`: windows of the record, by support vector machines "
          "trained on windows of the benchmark, as in the paper. `\"covariances\"`: the whole record, by "
          "covariances. `\"automatic\"`: windows if record and benchmark are at least four windows long")
          .allow("`\"automatic\"`, `\"windows\"`, `\"covariances\"`")
          .otherwise("`\"automatic\"`")
          .read([&options](const TomlTable& table, const std::string& key) {
            options.form =
                static_cast<ArxOeForm>(read_one_of(table, key, {"automatic", "windows", "covariances"}));
          }),
      whole("window", options.window, "length of a window")
          .otherwise("16 for each coefficient of its models"),
      whole("step", options.step, "distance between the starts of two windows")
          .otherwise("a quarter of a window"),
      share("nu", options.nu,
            "share of the training samples that may lie outside of the boundary of a support vector machine"),
      share("share", options.share,
            "a CV is flagged when more than this share of the windows of the record lie outside")};
}

/// Samples of a window for each coefficient of its models, by default.
constexpr Eigen::Index kSamplesOfCoefficient = 16;
/// Steps in a window, by default.
constexpr Eigen::Index kStepsOfWindow = 4;
/// From this number of windows without overlap on, a period shows how much healthy models scatter.
constexpr Eigen::Index kFewestWindows = 4;

/// Identifies the plant and the noise of a loop separately (Lu, Forbes, Loewen, Backstroem, Dumont and
/// Gopaluni 2020): a high-order ARX model gives the noise model, the record is filtered by its inverse, and
/// an output-error model of the plant is fitted to the filtered record. Each model is compared with that of a
/// healthy period. A changed plant is a mismatch, changed noise is a disturbance.
///
/// Here the difference between plant and model is identified, with three filters for each channel
/// (channel_filters), so that the output-error model is linear in its coefficients. If record and benchmark
/// are long enough, one-class support vector machines that have learnt the models of windows of the benchmark
/// judge those of the record (HealthyWindows). If they are short, each is one window, and plant, noise model
/// and size of the noise are compared by the covariances of their coefficients (compare_models()); this part
/// is not in the paper. A CV with a changed plant has the source mpm, a CV with changed noise ud, a CV with
/// both mpm_ud.
class ArxOe final : public AssessmentMethod {
 public:
  /// A benchmark exists, because the method requires one.
  explicit ArxOe(const AssessmentContext& context)
      : study_(context.study),
        options_(study_.assessment.of<ArxOeOptions>()),
        benchmark_(*context.benchmark),
        rule_(rule_of(benchmark_)) {
    if (benchmark_.samples() < fewest_samples_of(benchmark_))
      return;
    for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv) {
      const PlantAndNoise period = plant_and_noise(cv, benchmark_);
      if (options_.form != ArxOeForm::windows)
        healthy_.push_back(healthy_model(period));
      if (by_windows(benchmark_))
        windows_.emplace_back(period, rule_);
    }
  }

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::Index fewest = fewest_samples_of(loop);
    if (std::min(loop.samples(), benchmark_.samples()) < fewest)
      return Assessment::not_applicable(
          fmt::format("its models need {} samples or more, in the record and in the benchmark", fewest));
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const CvAssessment said = !windows_.empty() && by_windows(loop) ? judge_windows(cv, loop, assessment)
                                                                      : judge_cv(cv, loop, assessment);
      assessment.flagged = assessment.flagged || *said.flagged;
      assessment.score = std::fmax(assessment.score, said.score);
      assessment.cvs.push_back(said);
    }
    return assessment;
  }

 private:
  static Eigen::Index columns_of(const AssessedLoop& loop) {
    return kChannelFilters * (loop.u.rows() + loop.d.rows());
  }

  WindowRule rule_of(const AssessedLoop& loop) const {
    const Eigen::Index columns = columns_of(loop);
    const Eigen::Index window =
        options_.window > 0 ? options_.window : kSamplesOfCoefficient * (columns + kHighestNoiseOrder + 1);
    const Eigen::Index step =
        options_.step > 0 ? options_.step : std::max<Eigen::Index>(1, window / kStepsOfWindow);
    return {std::max(window, fewest_prewhitened_samples(columns)), step, options_.nu, options_.share};
  }

  bool by_windows(const AssessedLoop& loop) const {
    return options_.form == ArxOeForm::windows ||
           (options_.form == ArxOeForm::automatic && loop.samples() >= kFewestWindows * rule_.window);
  }

  /// With covariances, twice the samples that the regressions need, so that variances can be compared as
  /// well. With windows, two windows, so that the benchmark has a second one.
  Eigen::Index fewest_samples_of(const AssessedLoop& loop) const {
    return 2 * (options_.form == ArxOeForm::windows ? rule_.window
                                                    : fewest_prewhitened_samples(columns_of(loop)));
  }

  /// The values have the limit 1 instead of 0, as for covariances, and are 0 for a part that is not judged.
  CvAssessment judge_windows(Eigen::Index cv, const AssessedLoop& loop, Assessment& assessment) const {
    const HealthyWindows::Outside of =
        windows_[static_cast<std::size_t>(cv)].outside(plant_and_noise(cv, loop));
    const double plant = larger_or_nan(0.0, 1.0 + of.plant), noise = larger_or_nan(0.0, 1.0 + of.noise);
    assessment.numbers.push_back({"plant", plant, cv});
    assessment.numbers.push_back({"noise_model", noise, cv});
    return verdict(plant, noise);
  }

  static CvAssessment verdict(double plant, double noise) {
    const bool mpm = plant > 1.0, ud = noise > 1.0;
    return {mpm || ud, larger_or_nan(plant, noise),
            mpm && ud ? FaultSource::mpm_ud
            : mpm     ? FaultSource::mpm
            : ud      ? FaultSource::ud
                      : FaultSource::none};
  }

  CvAssessment judge_cv(Eigen::Index cv, const AssessedLoop& loop, Assessment& assessment) const {
    const double probability = kArxOeFalseAlarms / (kTestsOfCv * static_cast<double>(study_.cv_count()));
    const ModelComparison of =
        compare_models(plant_and_noise(cv, loop), healthy_[static_cast<std::size_t>(cv)], probability);
    assessment.numbers.push_back({"plant", of.plant, cv});
    assessment.numbers.push_back({"noise_model", of.noise_model, cv});
    assessment.numbers.push_back({"noise_variance", of.noise_variance, cv});
    return verdict(of.plant, larger_or_nan(of.noise_model, of.noise_variance));
  }

  PlantAndNoise plant_and_noise(Eigen::Index cv, const AssessedLoop& loop) const {
    const Eigen::MatrixXd inputs = inputs_until(loop);
    Eigen::MatrixXd filters(loop.samples(), 0);
    for (Eigen::Index j = 0; j < inputs.rows(); ++j) {
      const Eigen::MatrixXd of_channel =
          channel_filters(study_.assessed_channel(cv, j), study_.controller.sample_time,
                          inputs.row(j).transpose())
              .bottomRows(loop.samples());
      filters.conservativeResize(Eigen::NoChange, filters.cols() + of_channel.cols());
      filters.rightCols(of_channel.cols()) = of_channel;
    }
    return {(loop.y.row(cv) - loop.y_sim.row(cv)).transpose(), filters};
  }

  const Study& study_;
  const ArxOeOptions options_;
  const AssessedLoop& benchmark_;
  const WindowRule rule_;
  std::vector<HealthyModel> healthy_;    ///< one for each CV; empty if the benchmark is too short
  std::vector<HealthyWindows> windows_;  ///< one for each CV; empty if the benchmark is not judged by windows
};

}  // namespace

AssessmentMethodInfo arx_oe_method() {
  return {{.name = "arx-oe",
           .title = "after Lu et al. (2020), reconstructed",
           .verdict = "the plant or the noise of some CV differs from the benchmark",
           .requirements = {.benchmark = true, .moving_mvs = true},
           .locates_cvs = true,
           .tells_sources = true,
           .numbers =
               {{"plant", NumberScope::cv,
                 "squared distance of the plants over the threshold of chance; for windows 1 + ln(rho/f) of "
                 "the support vector machine that more than the share of the windows exceed"},
                {"noise_model", NumberScope::cv,
                 "squared distance of the noise models over the threshold of chance; for windows as `plant`"},
                {"noise_variance", NumberScope::cv,
                 "ratio of the variances of the innovations over the threshold of chance; NaN for windows, "
                 "whose noise model includes it"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<ArxOe>(context); },
          option_table<ArxOeOptions>(keys, "options of the windows of the ARX-OE method")};
}

}  // namespace mpm
