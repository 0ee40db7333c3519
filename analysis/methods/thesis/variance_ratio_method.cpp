#include <cmath>
#include <cstddef>
#include <memory>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/statistics/washout.hpp"

namespace mpm {
namespace {

/// The variance of each CV as Ivar_basis (6.22) defines it, with gaps closed by straight lines; 0 for a CV
/// that stands still.
Eigen::VectorXd cv_variances(const Study& study, const AssessedLoop& loop) {
  const Eigen::MatrixXd y = gaps_closed(loop.y);
  SetpointTrajectories centres;
  if (study.diagnosis.variance_centre != VarianceCentre::mean)
    for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
      centres.emplace_back();
      if (study.controller.has_setpoint(cv))
        centres.back() = loop.y_set.row(cv).transpose();
    }
  Eigen::VectorXd found = variances(y, centres);
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv)
    if (found(cv) <= variance_floor(y.row(cv).transpose()))
      found(cv) = 0.0;
  return found;
}

/// The baseline: compares var y / var y_benchmark with the band of impact. It knows neither model nor
/// controller.
class VarianceRatio final : public AssessmentMethod {
 public:
  /// A benchmark exists, because the method requires one.
  explicit VarianceRatio(const AssessmentContext& context)
      : study_(context.study), benchmark_(cv_variances(study_, *context.benchmark)) {}

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::VectorXd found = cv_variances(study_, loop);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < found.size(); ++cv) {
      const double ratio = variance_ratio(found(cv), benchmark_(cv));
      assessment.numbers.push_back({"ratio", ratio, cv});
      CvAssessment& of_cv = assessment.cvs.emplace_back();
      if (std::isnan(ratio))  // the CV stands still in both records
        continue;
      of_cv = {study_.diagnosis.has_impact(ratio),
               distance_from_one(ratio, study_.diagnosis.location_distance)};
      assessment.flagged = assessment.flagged || *of_cv.flagged;
      assessment.score = std::fmax(assessment.score, of_cv.score);
    }
    return assessment;
  }

 private:
  const Study& study_;
  Eigen::VectorXd benchmark_;
};

}  // namespace

AssessmentMethodInfo variance_ratio_method() {
  return {
      {.name = "variance-ratio",
       .title = "variance against the benchmark",
       .verdict = "var y / var y_benchmark of some CV lies outside the band of impact",
       .requirements = {.benchmark = true, .complete_record = false},
       .locates_cvs = true,
       .information = ModelInformation::unused,
       .numbers = {{"ratio", NumberScope::cv, "var y / var y_benchmark", "1", NumberFinding::regression}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<VarianceRatio>(context); }};
}

}  // namespace mpm
