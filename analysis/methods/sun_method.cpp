#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/model_quality.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

OrderCriterion criterion_of(SunCriterion criterion) {
  switch (criterion) {
    case SunCriterion::aic:
      return OrderCriterion::aic;
    case SunCriterion::bic:
      return OrderCriterion::bic;
    case SunCriterion::validation:
      break;
  }
  return OrderCriterion::validation_loss;
}

ModelQualityOptions quality_options(const SunOptions& sun) {
  ModelQualityOptions options;
  options.arx.outputs = sun.own_outputs ? ArxOutputs::own : ArxOutputs::all;
  options.arx.orders.assign(sun.orders.begin(), sun.orders.end());
  if (sun.setpoint_order > 0)
    options.arx.input_order = sun.setpoint_order;
  options.arx.criterion = criterion_of(sun.criterion);
  options.correct_for_parameters = sun.correct_for_parameters;
  return options;
}

/// Q_y of (2.4), as the controller's objective has it.
Eigen::VectorXd weights_of(const MpcOptions& controller) {
  return controller.weight_convention == WeightConvention::squared
             ? Eigen::VectorXd(controller.setpoint_weight.cwiseAbs2())
             : controller.setpoint_weight;
}

/// An autoregression of this order needs three times as many samples (autoregressive_noise()).
void require_long_benchmark(Eigen::Index samples, int order) {
  if (samples < 3 * order)
    throw InputError("assessment.sun.noise_order",
                     fmt::format("{} for a benchmark of {} samples", order, samples),
                     fmt::format("at most {}, a third of them", samples / 3));
}

/// G_d0 of each CV; none when it should come from a benchmark that is not known.
std::optional<std::vector<NoiseModel>> noise_models(const SunOptions& sun, const AssessmentContext& context) {
  std::vector<NoiseModel> models(static_cast<std::size_t>(context.study.cv_count()));
  if (sun.noise == SunNoise::integrated)
    std::fill(models.begin(), models.end(), integrated_noise(sun.noise_filter));
  if (sun.noise == SunNoise::benchmark) {
    if (!context.benchmark)
      return std::nullopt;
    require_long_benchmark(context.benchmark->samples(), sun.noise_order);
    const Eigen::MatrixXd v = context.benchmark->y - context.benchmark->y_sim;
    for (std::size_t i = 0; i < models.size(); ++i)
      models[i] = autoregressive_noise(v.row(static_cast<Eigen::Index>(i)).transpose(), sun.noise_order);
  }
  return models;
}

/// The signals that act on the loop from outside, a row each.
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
      : sun_(context.study.assessment.sun),
        options_(quality_options(sun_)),
        weights_(weights_of(context.study.controller)),
        noise_(noise_models(sun_, context)) {}

  Assessment assess(const AssessedLoop& loop) override {
    if (!noise_)
      return Assessment::not_applicable("its noise model comes from a benchmark period, and none is known");
    const Eigen::MatrixXd r = references_of(loop, sun_.measured_disturbances);
    if (const Eigen::Index fewest = fewest_samples(options_.arx, loop.y.rows(), r.rows());
        loop.samples() < fewest)
      return Assessment::not_applicable(
          fmt::format("its ARX models need {} samples or more, or other [assessment.sun] orders", fewest));
    const ModelQuality quality = model_quality(loop.y, r, loop.y_sim, weights_, *noise_, options_);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      add_cv(cv, loop.has_setpoint(cv), quality, assessment);
    judge_loop(quality.mqi, assessment);
    return assessment;
  }

 private:
  /// A CV that is held in a range has no setpoint that its moves could follow: nothing is said of it.
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

  /// By MQI; without weights of the CVs (a range MPC) by the worst CV, as 2.4.2 looks at each alone.
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
  std::optional<std::vector<NoiseModel>> noise_;
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
      [](const AssessmentContext& context) { return std::make_unique<Sun>(context); }};
}

}  // namespace mpm
