#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/model_quality.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

enum class SunIndex : std::int8_t { imqi, mqi };
enum class SunNoise : std::int8_t { integrated, benchmark, white };
/// The criteria by which one of several orders of the ARX model can be chosen.
constexpr std::array kSunCriteria{OrderCriterion::aic, OrderCriterion::bic, OrderCriterion::validation_loss};

struct SunOptions {
  double tolerance = 0.85;  ///< MQI and iMQI below this show a poor model (2.4.2)
  SunIndex index = SunIndex::imqi;
  std::vector<int> orders{20};          ///< MO1 of (2.1); one of several is chosen for each CV
  int setpoint_order = 0;               ///< MO2 of (2.1); 0: as MO1
  std::size_t criterion = 0;            ///< place in kSunCriteria
  bool own_outputs = false;             ///< AO of (2.1) is diagonal
  bool measured_disturbances = false;   ///< MDs are added to the setpoints in (2.1)
  bool correct_for_parameters = false;  ///< sums of squares of e^d over n - p instead of n
  SunNoise noise = SunNoise::integrated;
  double noise_filter = 0.7;  ///< c of `integrated`
  int noise_order = 10;       ///< highest order of `benchmark`

  bool operator==(const SunOptions&) const = default;
};

OptionKeys keys(SunOptions& options) {
  return {
      key::number("tolerance", options.tolerance, NumberRule::positive(),
                  "an MQI or iMQI below it shows a poor model. Section 2.4.2 has 0.85, chapter 4 has 0.8"),
      key::choice(
          "index", options.index, {"imqi", "mqi"},
          "index of a CV that is compared with `tolerance`: `\"imqi\"` is (4.3) with its root, as in chapter "
          "4; `\"mqi\"` is (2.4) of the CV alone, without the root, as in figures 2.15 and 2.16"),
      key::wholes(
          "orders", options.orders, 1, 100,
          "MO1 of (2.1); if there are several, one is chosen for each CV. Open; 20 is above the dead times "
          "of all shipped plants and takes 14 % of the degrees of freedom of 900 samples of three CVs"),
      key::whole("setpoint_order", options.setpoint_order, 0, 100,
                 "MO2 of (2.1); 0: the same as MO1, since no source gives a difference"),
      key::choice("criterion", options.criterion, {"aic", "bic", "validation"},
                  "criterion that chooses among several orders; `\"validation\"` is the mean squared "
                  "prediction error on the last 30 %. The default is AIC because the best predictor is "
                  "wanted and the loop of an offset-free controller is no ARX model of finite order"),
      key::flag("own_outputs", options.own_outputs,
                "use the past of the CV alone instead of the past of all CVs, for short records of many CVs. "
                "(2.1) has full matrices"),
      key::flag("measured_disturbances", options.measured_disturbances,
                "use measured disturbances beside the setpoints in (2.1), which has setpoints only"),
      key::flag("correct_for_parameters", options.correct_for_parameters,
                "divide sums of squares of e^d by n - p instead of n, with p fitted coefficients. (2.4) has "
                "plain sums"),
      key::choice("noise", options.noise, {"integrated", "benchmark", "white"},
                  "G_d0 of (2.2): the designed filter (1 - c q^-1)/(1 - q^-1), an autoregression "
                  "identified in the benchmark, or 1. `\"integrated\"` with c = 0 is what a controller "
                  "assumes that holds its output error constant"),
      key::number("noise_filter", options.noise_filter, NumberRule::below_one(),
                  "c. White errors of a perfect model have MQI (1 + c)/2 under this filter: 0.7 is the c "
                  "nearest to the controller's own at which the tolerance 0.85 does not flag them"),
      key::whole("noise_order", options.noise_order, 0, 100,
                 "highest order of the autoregression; BIC chooses")};
}

ModelQualityOptions quality_options(const SunOptions& sun) {
  ModelQualityOptions options;
  options.arx.outputs = sun.own_outputs ? ArxOutputs::own : ArxOutputs::all;
  options.arx.orders.assign(sun.orders.begin(), sun.orders.end());
  if (sun.setpoint_order > 0)
    options.arx.input_order = sun.setpoint_order;
  options.arx.criterion = kSunCriteria[sun.criterion];
  options.correct_for_parameters = sun.correct_for_parameters;
  return options;
}

/// Q_y of (2.4), in the convention of the controller's objective.
Eigen::VectorXd weights_of(const MpcOptions& controller) {
  return controller.weight_convention == WeightConvention::squared
             ? Eigen::VectorXd(controller.setpoint_weight.cwiseAbs2())
             : controller.setpoint_weight;
}

/// Why there is no noise model: it should come from a benchmark, which is not known or shorter than three
/// times the order of the autoregression (autoregressive_noise()). None if there is one.
std::optional<std::string> unmet_noise(const SunOptions& sun, const AssessmentContext& context) {
  if (sun.noise != SunNoise::benchmark)
    return std::nullopt;
  if (!context.benchmark)
    return "its noise model comes from a benchmark period, and none is known";
  if (const Eigen::Index samples = context.benchmark->samples(); samples < 3 * sun.noise_order)
    return fmt::format("assessment.sun.noise_order is {}, and a benchmark of {} samples allows at most {}",
                       sun.noise_order, samples, samples / 3);
  return std::nullopt;
}

/// G_d0 of each CV; unmet_noise() must be none.
std::vector<NoiseModel> noise_models(const SunOptions& sun, const AssessmentContext& context) {
  std::vector<NoiseModel> models(static_cast<std::size_t>(context.study.cv_count()));
  if (sun.noise == SunNoise::integrated)
    std::fill(models.begin(), models.end(), integrated_noise(sun.noise_filter));
  if (sun.noise == SunNoise::benchmark) {
    const Eigen::MatrixXd v = context.benchmark->y - context.benchmark->y_sim;
    for (std::size_t i = 0; i < models.size(); ++i)
      models[i] = autoregressive_noise(v.row(static_cast<Eigen::Index>(i)).transpose(), sun.noise_order);
  }
  return models;
}

/// The signals that act on the loop from outside, one row each.
Eigen::MatrixXd references_of(const AssessedLoop& loop, bool measured_disturbances) {
  const std::vector<Eigen::Index> cvs = loop.setpoint_cvs();
  const auto setpoints = static_cast<Eigen::Index>(cvs.size());
  Eigen::MatrixXd references(setpoints + (measured_disturbances ? loop.d.rows() : 0), loop.samples());
  for (Eigen::Index i = 0; i < setpoints; ++i)
    references.row(i) = loop.y_set.row(cvs[static_cast<std::size_t>(i)]);
  if (measured_disturbances)
    references.bottomRows(loop.d.rows()) = loop.d;
  return references;
}

class Sun final : public AssessmentMethod {
 public:
  explicit Sun(const AssessmentContext& context)
      : sun_(context.study.assessment.of<SunOptions>()),
        options_(quality_options(sun_)),
        weights_(weights_of(context.study.controller)),
        unmet_(unmet_noise(sun_, context)),
        noise_(unmet_ ? std::vector<NoiseModel>() : noise_models(sun_, context)) {}

  Assessment assess(const AssessedLoop& loop) override {
    if (unmet_)
      return Assessment::not_applicable(*unmet_);
    const Eigen::MatrixXd r = references_of(loop, sun_.measured_disturbances);
    if (const Eigen::Index fewest = fewest_samples(options_.arx, loop.y.rows(), r.rows());
        loop.samples() < fewest)
      return Assessment::not_applicable(
          fmt::format("its ARX models need {} samples or more, or other [assessment.sun] orders", fewest));
    const ModelQuality quality = model_quality(loop.y, r, loop.y_sim, weights_, noise_, options_);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      add_cv(cv, loop.has_setpoint(cv), quality, assessment);
    judge_loop(quality.mqi, assessment);
    return assessment;
  }

 private:
  /// A CV in a range has no setpoint to explain its moves, so it gets no verdict.
  void add_cv(Eigen::Index cv, bool has_setpoint, const ModelQuality& quality, Assessment& assessment) const {
    const double imqi = quality.imqi(cv);
    const double index = sun_.index == SunIndex::imqi ? imqi : imqi * imqi;
    CvAssessment said;
    if (has_setpoint && std::isfinite(index)) {
      said.flagged = index < sun_.tolerance;
      said.score = 1.0 - index;
    }
    assessment.cvs.push_back(said);
    assessment.numbers.push_back({"imqi", imqi, cv});
    assessment.numbers.push_back({"mqi_cv", imqi * imqi, cv});
    assessment.numbers.push_back(
        {"order", static_cast<double>(quality.orders[static_cast<std::size_t>(cv)]), cv});
  }

  /// Judges the loop by MQI. If the CVs have no weights (a range MPC), it goes by the worst CV, as 2.4.2
  /// looks at each alone.
  void judge_loop(double mqi, Assessment& assessment) const {
    assessment.numbers.push_back({"mqi", mqi});
    if (std::isfinite(mqi)) {
      assessment.flagged = mqi < sun_.tolerance;
      assessment.score = 1.0 - mqi;
    } else if (const std::optional<Eigen::Index> worst = assessment.worst_cv()) {
      const CvAssessment& said = assessment.cvs[static_cast<std::size_t>(*worst)];
      assessment.flagged = said.flagged.value_or(false);
      assessment.score = said.score;
    } else {
      assessment = Assessment::failed("no CV has prediction errors");
    }
  }

  const SunOptions& sun_;
  ModelQualityOptions options_;
  Eigen::VectorXd weights_;
  std::optional<std::string> unmet_;
  std::vector<NoiseModel> noise_;
};

}  // namespace

AssessmentMethodInfo sun_method() {
  return {
      {.name = "sun",
       .title = "Sun et al. (2013)",
       .verdict = "the model is poor: MQI, or without weights the index of a CV, lies below the tolerance",
       .requirements = {.setpoints = true},
       .locates_cvs = true,
       .names_channels = false,
       .tells_sources = false,
       .numbers = {{"mqi", NumberScope::loop, "weighted squares of e^d over those of e^p (2.4)"},
                   {"imqi", NumberScope::cv, "|e^d| / |e^p| of the CV (4.3)"},
                   {"mqi_cv", NumberScope::cv, "(2.4) of the CV alone, the square of iMQI"},
                   {"order", NumberScope::cv, "MO1 of its high-order ARX model (2.1)"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Sun>(context); },
      option_table<SunOptions>(keys, "options of the method of Sun et al.")};
}

}  // namespace mpm
