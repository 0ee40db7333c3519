#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/shared/error_regression.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct CandidatesOptions {
  ErrorRegressionOptions regression;

  bool operator==(const CandidatesOptions&) const = default;
};

OptionKeys keys(CandidatesOptions& options) {
  return keys(options.regression);
}

/// Finds inputs that the model lacks (thesis, 8.2): tests whether logged signals that are not in the model
/// help to predict the simulation errors. prewhitened_test() tests e_i on each candidate alone. Each CV has
/// the candidate with the smallest p-value; a flagged loop names that of its worst CV. Each p-value counts as
/// that of one of ny nc tests, with nc candidates.
class Candidates final : public AssessmentMethod {
 public:
  explicit Candidates(const AssessmentContext& context)
      : options_(context.study.assessment.of<CandidatesOptions>().regression) {}

  Assessment assess(const AssessedLoop& loop) override {
    if (loop.candidates.rows() == 0)
      return Assessment::not_applicable("no signal outside of the model is logged");
    const std::vector<Eigen::MatrixXd> filtered =
        filtered_in_window(loop, loop.from_start().candidates, options_);
    const Eigen::MatrixXd e = model_errors(loop);
    Assessment assessment;
    assessment.cvs.resize(static_cast<std::size_t>(e.rows()));
    for (std::size_t candidate = 0; candidate < filtered.size(); ++candidate)
      add_candidate(static_cast<Eigen::Index>(candidate), filtered, e, assessment);
    const std::optional<Eigen::Index> worst = assessment.worst_cv();
    if (!worst)
      return Assessment::not_applicable(fmt::format("its regressions need {} samples of a CV without a gap",
                                                    error_regression_samples(options_, 1)));
    if (assessment.flagged)
      assessment.named_candidate = static_cast<Eigen::Index>(assessment.number("candidate", *worst));
    return assessment;
  }

 private:
  /// Keeps the score of this candidate on each CV on which no earlier candidate has a higher one.
  void add_candidate(Eigen::Index candidate, const std::vector<Eigen::MatrixXd>& filtered,
                     const Eigen::MatrixXd& e, Assessment& assessment) const {
    const auto regressions = error_regressions(e, {filtered[static_cast<std::size_t>(candidate)]}, options_);
    const auto tests = static_cast<double>(e.rows()) * static_cast<double>(filtered.size());
    for (Eigen::Index cv = 0; cv < e.rows(); ++cv) {
      const std::optional<ErrorRegression>& found = regressions[static_cast<std::size_t>(cv)];
      CvAssessment& said = assessment.cvs[static_cast<std::size_t>(cv)];
      const double log_p = found ? found->test.all.log_p : 0.0;
      const double score = significance_score(log_p, tests);
      if (!found || score <= said.score)
        continue;
      const bool flagged = score > -std::log10(options_.alpha);
      said = {flagged, score, flagged ? FaultSource::ud : FaultSource::none};
      assessment.flagged = assessment.flagged || flagged;
      assessment.score = std::isnan(assessment.score) ? score : std::max(assessment.score, score);
      set_number("candidate", static_cast<double>(candidate), cv, assessment);
      set_number("log10_p", log_p / std::numbers::ln10, cv, assessment);
    }
  }

  static void set_number(const char* name, double value, Eigen::Index cv, Assessment& assessment) {
    for (AssessmentNumber& number : assessment.numbers)
      if (number.name == name && number.cv == cv) {
        number.value = value;
        return;
      }
    assessment.numbers.push_back({name, value, cv});
  }

  const ErrorRegressionOptions& options_;
};

}  // namespace

AssessmentMethodInfo candidates_method() {
  return {
      {.name = "candidates",
       .title = "inputs that the model lacks, among logged signals",
       .verdict = "a logged signal that is not in the model helps to predict the simulation error of some CV",
       .requirements = {.complete_record = false},
       .locates_cvs = true,
       .names_channels = false,
       .tells_sources = true,
       .names_candidates = true,
       .information = ModelInformation::shown,
       .numbers =
           {{"candidate", NumberScope::cv, "position of the logged signal with the smallest p-value"},
            {"log10_p", NumberScope::cv,
             "log10 p of the hypothesis that this signal does not help to predict the error of the CV"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Candidates>(context); },
      option_table<CandidatesOptions>(
          keys, "options of the test of the simulation errors against further logged signals"),
      [](const MethodOptions& options) { return options.of<CandidatesOptions>().regression.alpha; }};
}

}  // namespace mpm
