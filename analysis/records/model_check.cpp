#include "analysis/records/model_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/channel_health.hpp"
#include "analysis/records/record_alternatives.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

class ModelCheck final : public AssessmentMethod {
 public:
  ModelCheck(const AssessmentContext& context, double delta)
      : study_(context.study), fits_(context.study, delta), settling_(slowest_settling(context.study)) {}

  Assessment assess(const AssessedLoop& loop) override {
    Assessment assessment;
    assessment.score = 0.0;
    double health = 0.0, dependence = 0.0;
    const std::vector<Eigen::Index> begins = health_periods(loop.samples(), settling_);
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const ChannelErrorFit fit = fits_.of(loop, cv);
      const double score = error_score(fit.a, fit.left, fit.noise);
      assessment.cvs.push_back({score > kFarTooLarge, score});
      assessment.score = std::max(assessment.score, score);
      assessment.numbers.push_back({"noise", fit.noise, cv});
      if (const double F = input_dependence(study_, loop, fit, cv); F > dependence)
        dependence = F;
      for (const ChannelHistory& history : channel_histories(fit, cv, begins, loop.samples(), kInfinity))
        for (const ChannelPeriod& period : history.periods)
          health = std::max(health, period.score);
    }
    assessment.numbers.push_back({"health", health});
    assessment.numbers.push_back({kFitNumber, dependence});
    assessment.flagged = assessment.score > kFarTooLarge;
    return assessment;
  }

 private:
  const Study& study_;
  ChannelErrorFits fits_;
  Eigen::Index settling_;
};

/// Over the samples that are there, about their mean.
double variance_of_known(const Eigen::RowVectorXd& y) {
  const auto is_there = !y.array().isNaN();
  const auto count = static_cast<double>(is_there.count());
  const double mean = is_there.select(y.array(), 0.0).sum() / count;
  return is_there.select((y.array() - mean).square(), 0.0).sum() / count;
}

}  // namespace

std::vector<UnexplainedCv> unexplained_cvs(const Study& study, const AssessedLoop& loop, double delta) {
  constexpr double kMostLeft = 0.5;
  const ChannelErrorFits fits(study, delta);
  std::vector<UnexplainedCv> found;
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
    if ((!(loop.y.row(cv) - loop.y_sim.row(cv)).array().isNaN()).count() < 2)
      continue;  // nothing is known of its noise
    const ChannelErrorFit fit = fits.of(loop, cv);
    const double noise = std::sqrt(fit.noise) / study.simulation.noise_standard_deviation(cv);
    if (std::isfinite(noise) && noise > kMostNoise &&
        fit.left > kMostLeft * variance_of_known(loop.y.row(cv)))
      found.push_back({cv, noise});
  }
  return found;
}

AssessmentMethodInfo model_check_method(double delta) {
  return {
      {.name = kModelCheck,
       .title = "errors of the model",
       .verdict = "the simulation errors of some CV are larger than noise and errors of the model of some "
                  "percent make them",
       .requirements = {.complete_record = false},
       .locates_cvs = true,
       .numbers = {{"noise", NumberScope::cv, "half of the mean squared difference of successive errors",
                    "CV unit^2"},
                   {"health", NumberScope::loop, "largest score of a channel in a period of its own"},
                   {kFitNumber, NumberScope::loop, "largest input_dependence() of a CV"},
                   {kCostNumber, NumberScope::cv, "cost over that of the loop as designed"},
                   {kCostSinceNumber, NumberScope::cv, "the same since the onset of the record"}},
       .origin = "mpmbench assess",
       .fingerprint = fmt::format("{:g}", delta)},
      {},
      [delta](const AssessmentContext& context) { return std::make_unique<ModelCheck>(context, delta); }};
}

}  // namespace mpm
