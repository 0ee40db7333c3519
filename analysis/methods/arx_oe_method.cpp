#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/channel_regressors.hpp"
#include "analysis/methods/model_comparison.hpp"
#include "analysis/methods/prewhitened_groups.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

/// The probability that is shared out to the tests of all CVs, one of the plant and two of the noise. It is
/// not stated as that of a false alarm: one benchmark serves for all loops of a study, and more are flagged.
constexpr double kArxOeFalseAlarms = 0.01;
constexpr double kTestsOfCv = 3.0;

/// Plant and noise of a loop apart (Lu, Forbes, Loewen, Backstroem, Dumont and Gopaluni 2020): a high-order
/// ARX model gives the noise model, the record is filtered by its inverse, and an output-error model of the
/// plant is fitted to what comes out; each is held against what it was in a healthy period. A plant that has
/// changed is a mismatch, noise that has changed is a disturbance.
///
/// A reconstruction, and with other means where the record is short. The plant is identified by what it
/// differs from the model, with three filters a channel (channel_filters), so that the output-error model is
/// linear in its coefficients; the noise model is an autoregression of least BIC. The paper trains a
/// one-class support vector machine on the models of many windows of the healthy period; here the record is
/// one window and the benchmark another, and plant, noise model and size of the noise are held against each
/// other by the covariances of their coefficients (compare_models()). A CV with another plant has the source
/// mpm, one with other noise ud, one with both mpm_ud.
class ArxOe final : public AssessmentMethod {
 public:
  /// The requirements of the method say that there is a benchmark.
  explicit ArxOe(const AssessmentContext& context) : study_(context.study), benchmark_(*context.benchmark) {
    if (benchmark_.samples() >= fewest_samples_of(benchmark_))
      for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv)
        healthy_.push_back(healthy_model(plant_and_noise(cv, benchmark_)));
  }

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::Index fewest = fewest_samples_of(loop);
    if (std::min(loop.samples(), benchmark_.samples()) < fewest)
      return Assessment::not_applicable(
          fmt::format("its models need {} samples or more, in the record and in the benchmark", fewest));
    Assessment assessment;
    assessment.score = 0.0;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const CvAssessment said = judge_cv(cv, loop, assessment);
      assessment.flagged = assessment.flagged || *said.flagged;
      assessment.score = std::max(assessment.score, said.score);
      assessment.cvs.push_back(said);
    }
    return assessment;
  }

 private:
  /// Twice what the regressions need, so that variances can be compared as well.
  static Eigen::Index fewest_samples_of(const AssessedLoop& loop) {
    return 2 * fewest_prewhitened_samples(kChannelFilters * (loop.u.rows() + loop.d.rows()));
  }

  CvAssessment judge_cv(Eigen::Index cv, const AssessedLoop& loop, Assessment& assessment) const {
    const double probability = kArxOeFalseAlarms / (kTestsOfCv * static_cast<double>(study_.cv_count()));
    const ModelComparison of =
        compare_models(plant_and_noise(cv, loop), healthy_[static_cast<std::size_t>(cv)], probability);
    assessment.numbers.push_back({"plant", of.plant, cv});
    assessment.numbers.push_back({"noise_model", of.noise_model, cv});
    assessment.numbers.push_back({"noise_variance", of.noise_variance, cv});
    const double noise = std::max(of.noise_model, of.noise_variance);
    const bool mpm = of.plant > 1.0, ud = noise > 1.0;
    return {mpm || ud, std::max(of.plant, noise),
            mpm && ud ? FaultSource::mpm_ud
            : mpm     ? FaultSource::mpm
            : ud      ? FaultSource::ud
                      : FaultSource::none};
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
  const AssessedLoop& benchmark_;
  std::vector<HealthyModel> healthy_;  ///< of each CV; none when the benchmark is too short
};

}  // namespace

AssessmentMethodInfo arx_oe_method() {
  return {{.name = "arx-oe",
           .title = "Lu et al. (2020), reconstruction",
           .verdict = "the plant or the noise of some CV is not what it was in the benchmark",
           .requirements = {.benchmark = true, .moving_mvs = true},
           .locates_cvs = true,
           .tells_sources = true,
           .numbers = {{"plant", NumberScope::cv,
                        "squared distance of the plants over the one that chance exceeds"},
                       {"noise_model", NumberScope::cv,
                        "squared distance of the noise models over the one that chance exceeds"},
                       {"noise_variance", NumberScope::cv,
                        "ratio of the variances of the innovations over the one that chance exceeds"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<ArxOe>(context); }};
}

}  // namespace mpm
