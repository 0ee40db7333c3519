#include "analysis/records/model_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "analysis/records/channel_error_fit.hpp"
#include "analysis/statistics/best_candidate.hpp"

namespace mpm {
namespace {

/// A score that is flagged without simulated records. Of 26 healthy records (tests/reliability/records.py,
/// seeds 2 and 3) the largest was 1.16.
constexpr double kFarTooLarge = 1.5;
constexpr double kUsual = 2.0;  ///< the largest of some errors of the model, standard deviations

class ModelCheck final : public AssessmentMethod {
 public:
  ModelCheck(const AssessmentContext& context, double delta) : fits_(context.study, delta) {}

  Assessment assess(const AssessedLoop& loop) override {
    Assessment assessment;
    assessment.score = 0.0;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const ChannelErrorFit fit = fits_.of(loop, cv);
      const double off = fit.a.size() > 0 ? fit.a.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / kUsual : 0.0;
      const double score = larger_or_nan(off, std::sqrt(fit.left / fit.noise));
      assessment.cvs.push_back({score > kFarTooLarge, score});
      assessment.score = std::max(assessment.score, score);
    }
    assessment.flagged = assessment.score > kFarTooLarge;
    return assessment;
  }

 private:
  ChannelErrorFits fits_;
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
  constexpr double kMostLeft = 0.5, kMostNoise = 10.0;
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
       .numbers = {},
       .origin = "mpmbench assess",
       .fingerprint = fmt::format("{:g}", delta)},
      {},
      [delta](const AssessmentContext& context) { return std::make_unique<ModelCheck>(context, delta); }};
}

}  // namespace mpm
