#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/identification/noise_filter.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/shared/error_regression.hpp"
#include "analysis/methods/shared/outside_signals.hpp"
#include "analysis/statistics/mutual_information.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

enum class DependenceMeasure : std::int8_t { f, mutual_information };

struct ExcitationOptions {
  ErrorRegressionOptions regression;
  DependenceMeasure measure = DependenceMeasure::f;
  int bins = 4;  ///< bins of each signal, for the mutual information

  bool operator==(const ExcitationOptions&) const = default;
};

OptionKeys keys(ExcitationOptions& options) {
  OptionKeys all = keys(options.regression);
  all.push_back(
      key::choice("measure", options.measure, {"f", "mutual-information"},
                  "test that the error follows a signal. `\"f\"`: the F test of a linear regression. "
                  "`\"mutual-information\"`: it also sees nonlinear relations, but they must be stronger"));
  all.push_back(key::whole("bins", options.bins, 2, 100,
                           "number of bins of each signal for the mutual information. A record needs 5 "
                           "samples for each pair of bins"));
  return all;
}

/// Tests the simulation errors against signals that act on the loop and on which nothing in the loop acts. No
/// unmeasured disturbance can know them, so a simulation error that follows them shows a wrong model, in
/// closed loop, too, and whatever disturbs the loop. Related methods are the cross-correlations of Webber and
/// Gupta (2008), a paper that we could not get, and the mutual information of Gao, Chen, Xie, Su and Wang
/// (2012, IFAC Proceedings Volumes, ADCHEM), of which we have the abstract: mutual information between
/// dithering signals and model residuals shows a mismatch "regardless of change in disturbance dynamics". The
/// abstract has neither estimator nor limits, so the tests are our own.
///
///   measure f:                   prewhitened_test() of e_i on the filtered signals together
///   measure mutual_information:  binned_information() of the whitened e_i and each filtered signal, as it
///                                is and whitened as e_i; the least of their p-values, times their number
///
/// Each p-value is that of one of ny tests.
class Excitation final : public AssessmentMethod {
 public:
  explicit Excitation(const AssessmentContext& context)
      : signals_(context.study), options_(context.study.assessment.of<ExcitationOptions>()) {
    if (context.benchmark && context.correction)
      usual_ = error_regressions(model_errors(*context.benchmark), filtered_of(*context.benchmark),
                                 options_.regression);
  }

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::MatrixXd signals = signals_.of(loop.from_start());
    if (moving_rows(loop.in_window(signals)).rows() == 0)
      return Assessment::not_applicable(
          "no measured disturbance, setpoint, limit or test signal moves the loop");
    const std::vector<Eigen::MatrixXd> filtered = filtered_in_window(loop, signals, options_.regression);
    const Eigen::MatrixXd e = model_errors(loop);
    const auto regressions = error_regressions(e, filtered, options_.regression);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < e.rows(); ++cv) {
      const std::optional<ErrorRegression>& found = regressions[static_cast<std::size_t>(cv)];
      if (found)
        add_cv(cv, *found, e, filtered, assessment);
      else
        assessment.cvs.emplace_back();
    }
    if (!assessment.worst_cv())
      return Assessment::not_applicable(
          fmt::format("its regressions need {} samples of a CV without a gap",
                      error_regression_samples(options_.regression, signals.rows())));
    return assessment;
  }

 private:
  std::vector<Eigen::MatrixXd> filtered_of(const AssessedLoop& loop) const {
    return filtered_in_window(loop, signals_.of(loop.from_start()), options_.regression);
  }

  void add_cv(Eigen::Index cv, const ErrorRegression& found, const Eigen::MatrixXd& e,
              const std::vector<Eigen::MatrixXd>& filtered, Assessment& assessment) const {
    const double log_p = options_.measure == DependenceMeasure::f
                             ? new_in(found, cv, usual_).all.log_p
                             : log_p_of_information(e.row(cv).transpose(), found.whiteness, filtered);
    const double score = significance_score(log_p, static_cast<double>(e.rows()));
    const bool flagged = score > -std::log10(options_.regression.alpha);
    assessment.cvs.push_back({flagged, score, flagged ? FaultSource::mpm : FaultSource::none});
    assessment.flagged = assessment.flagged || flagged;
    assessment.score = std::isnan(assessment.score) ? score : std::max(assessment.score, score);
    assessment.numbers.push_back({"log10_p", log_p / std::numbers::ln10, cv});
    assessment.numbers.push_back({"autoregression", static_cast<double>(found.test.order), cv});
  }

  double log_p_of_information(const Eigen::VectorXd& e, const Autoregression& whiteness,
                              const std::vector<Eigen::MatrixXd>& filtered) const {
    const Eigen::VectorXd w = whiteness.whitened(e);
    double least = 0.0;
    Eigen::Index looks = 0;
    for (const Eigen::MatrixXd& group : filtered) {
      const Eigen::MatrixXd white = whiteness.whitened(group);
      for (Eigen::Index j = 0; j < group.cols(); ++j) {
        const Eigen::VectorXd as_it_is = group(whiteness.rows, j);
        least = std::min({least, binned_information(w, as_it_is, options_.bins).log_p,
                          binned_information(w, white.col(j), options_.bins).log_p});
        looks += 2;
      }
    }
    return std::min(0.0, least + std::log(static_cast<double>(looks)));
  }

  OutsideSignals signals_;
  const ExcitationOptions& options_;
  ErrorRegressions usual_;  ///< regressions of a benchmark that has corrected the model, or empty
};

}  // namespace

AssessmentMethodInfo excitation_method() {
  return {
      {.name = "excitation",
       .title = "simulation errors that follow the excitation",
       .verdict = "signals from outside of the loop help to predict the simulation error of some CV: the "
                  "model is wrong, whatever disturbs the loop",
       .requirements = {.complete_record = false},
       .locates_cvs = true,
       .names_channels = false,
       .tells_sources = true,
       .information = ModelInformation::shown,
       .numbers =
           {{"log10_p", NumberScope::cv,
             "log10 p of the hypothesis that no signal from outside helps to predict the error of the CV"},
            {"autoregression", NumberScope::cv, "order of the autoregression of the error"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Excitation>(context); },
      option_table<ExcitationOptions>(
          keys, "options of the test of the simulation errors against signals from outside"),
      [](const MethodOptions& options) { return options.of<ExcitationOptions>().regression.alpha; }};
}

}  // namespace mpm
