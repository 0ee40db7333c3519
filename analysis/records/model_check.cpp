#include "analysis/records/model_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include <fmt/format.h>

#include "analysis/methods/ours/fault_comparison.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/channel_health.hpp"
#include "analysis/records/model_habit.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

class ModelCheck final : public AssessmentMethod {
 public:
  ModelCheck(const AssessmentContext& context, double delta)
      : study_(context.study),
        fits_(context.study, delta),
        habit_(record_habit(context, delta)),
        beside_habit_(context.study, delta, habit_),
        settling_(slowest_settling(context.study)) {}

  Assessment assess(const AssessedLoop& loop) override {
    Assessment assessment;
    assessment.score = 0.0;
    double health = 0.0, dependence = 0.0;
    const std::vector<Eigen::Index> begins = health_periods(loop.samples(), settling_);
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const ChannelErrorFit fit = fits_.of(loop, cv);
      const ChannelErrorFit beside = habit_ ? beside_habit_.of(loop, cv) : fit;
      const double score = score_of(beside, loop.first);
      assessment.cvs.push_back({score > kFarTooLarge, score});
      assessment.score = std::max(assessment.score, score);
      assessment.numbers.push_back({"noise", fit.noise, cv});
      if (const double found = input_dependence(study_, loop, {loop, cv, fit.samples, fit.e, fit.X}, cv);
          found > dependence)
        dependence = found;
      for (const ChannelHistory& history : channel_histories(beside, cv, begins, loop.samples(), kInfinity))
        for (const ChannelPeriod& period : history.periods)
          health = std::max(health, period.score);
    }
    assessment.numbers.push_back({"health", health});
    assessment.numbers.push_back({kFitNumber, dependence});
    assessment.flagged = assessment.score > kFarTooLarge;
    return assessment;
  }

 private:
  /// The score over all samples, or with a habit over those outside of its period, which says nothing new
  /// about itself. `first`: first sample of the window in the record.
  double score_of(const ChannelErrorFit& fit, Eigen::Index first) const {
    if (habit_ == nullptr)
      return error_score(fit.a, fit.left, fit.noise);
    ChannelErrorSums outside = sums_between(fit, 0, fit.samples.back() + 1);
    const ChannelErrorSums inside = sums_between(fit, habit_->first - first, habit_->end - first);
    if (inside.n < outside.n)
      outside -= inside;
    const PartialErrorFit part = fit_of(outside, fit.noise);
    // Beside a habit a record tells little about some errors. With a ~ N(0, I) before the record and
    // covariance C after it, the means of a have the variances 1 - C_ii if nothing is wrong.
    const Eigen::Index p = part.a.size();
    const Eigen::ArrayXd told = (1.0 - part.covariance.diagonal().head(p).array()).max(1e-12);
    return error_score((part.a.array() / told.sqrt()).matrix(), part.left, fit.noise);
  }

  const Study& study_;
  ChannelErrorFits fits_;
  std::shared_ptr<const ModelHabit> habit_;
  ChannelErrorFits beside_habit_;
  Eigen::Index settling_;
};

/// The variance of the samples that are there, about their mean.
double variance_of_known(const Eigen::RowVectorXd& y) {
  const auto is_there = !y.array().isNaN();
  const auto count = static_cast<double>(is_there.count());
  const double mean = is_there.select(y.array(), 0.0).sum() / count;
  return is_there.select((y.array() - mean).square(), 0.0).sum() / count;
}

}  // namespace

std::shared_ptr<const ModelHabit> record_habit(const AssessmentContext& context, double delta) {
  const bool is_period = context.benchmark && context.benchmark->whole != nullptr;
  return is_period && delta > 0.0 ? habit_of(context.study, delta, *context.benchmark) : nullptr;
}

std::vector<UnexplainedCv> unexplained_cvs(const Study& study, const AssessedLoop& loop, double delta,
                                           const ModelHabit* habit) {
  constexpr double kMostLeft = 0.5;
  const ChannelErrorFits fits(study, delta);
  std::vector<UnexplainedCv> found;
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
    if ((!(loop.y.row(cv) - loop.y_sim.row(cv)).array().isNaN()).count() < 2)
      continue;  // nothing is known of its noise
    const ChannelErrorFit fit = fits.of(loop, cv);
    double usual = study.simulation.noise_standard_deviation(cv);
    if (habit != nullptr && habit->noise[static_cast<std::size_t>(cv)])
      usual = std::max(usual, std::sqrt(habit->noise[static_cast<std::size_t>(cv)]->differences));
    const double noise = std::sqrt(fit.noise) / usual;
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
