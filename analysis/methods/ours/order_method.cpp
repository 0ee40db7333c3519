#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/shared/error_regression.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "analysis/statistics/holm.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct OrderOptions {
  ErrorRegressionOptions regression;
  bool disturbances = true;  ///< an error with another colour than in the benchmark is flagged

  bool operator==(const OrderOptions&) const = default;
};

OptionKeys keys(OrderOptions& options) {
  OptionKeys all = keys(options.regression);
  all.push_back(
      key::flag("disturbances", options.disturbances,
                "a simulation error that is coloured in another way than in the benchmark, or about another "
                "mean, is flagged as a disturbance; false: a monitor of the model alone"));
  return all;
}

/// Tests the order from the MVs to the simulation errors e_i = y_i - y_sim,i: whether past moves of the MVs
/// help to predict e_i once its own past is known. If they do not (order 0), the model is right, and the
/// colour of e comes from a disturbance. If they do, the model is wrong. Pannocchia, De Luca and Bottai
/// (2014, Asian J. Control 16, 995-1005) prove this for the order of a minimal realisation, which they find
/// by closed-loop subspace identification. We have read the abstract of their paper only; the tests here are
/// our own.
///
///   mismatch:     prewhitened_test() of e_i on the filtered MVs; a channel by the partial F of its MV
///   disturbance:  log_p_same_autoregression() of e_i and of the e_i of the benchmark: another colour than
///                 noise has, or another mean; not another variance, which noise may have
///
/// If the benchmark corrects the model, what the correction cannot express follows the MVs in the benchmark,
/// too. Then the test is of what the MVs explain beyond that (new_in()).
///
/// Each p-value is that of one of 2 ny tests (ny without a benchmark). A CV whose error follows the MVs has
/// the source mpm, any other flagged CV ud.
class Order final : public AssessmentMethod {
 public:
  explicit Order(const AssessmentContext& context) : options_(context.study.assessment.of<OrderOptions>()) {
    if (!context.benchmark)
      return;
    if (options_.disturbances)
      benchmark_ = model_errors(*context.benchmark);
    if (context.correction)
      usual_ = regressions_of(model_errors(*context.benchmark), *context.benchmark);
  }

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::MatrixXd e = model_errors(loop);
    const ErrorRegressions regressions = regressions_of(e, loop);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < e.rows(); ++cv) {
      const std::optional<ErrorRegression>& found = regressions[static_cast<std::size_t>(cv)];
      if (found)
        add_cv(cv, *found, e, assessment);
      else
        assessment.cvs.emplace_back();
    }
    if (!assessment.worst_cv())
      return Assessment::not_applicable(
          fmt::format("its regressions need {} samples of a CV without a gap",
                      error_regression_samples(options_.regression, loop.u.rows())));
    return assessment;
  }

 private:
  ErrorRegressions regressions_of(const Eigen::MatrixXd& e, const AssessedLoop& loop) const {
    return error_regressions(e, filtered_in_window(loop, loop.from_start().u, options_.regression),
                             options_.regression);
  }

  void add_cv(Eigen::Index cv, const ErrorRegression& found, const Eigen::MatrixXd& e,
              Assessment& assessment) const {
    const double tests = static_cast<double>(e.rows()) * (benchmark_ ? 2.0 : 1.0);
    const double limit = -std::log10(options_.regression.alpha);
    const std::optional<double> noise = log_p_of_noise(e.row(cv).transpose(), cv, found.test.order);
    const PrewhitenedTest test = new_in(found, cv, usual_);
    const double of_model = significance_score(test.all.log_p, tests);
    CvAssessment said{of_model > limit, of_model, of_model > limit ? FaultSource::mpm : FaultSource::none};
    if (noise) {
      const double of_noise = significance_score(*noise, tests);
      if (of_noise > limit && !*said.flagged)
        said.source = FaultSource::ud;
      said.flagged = *said.flagged || of_noise > limit;
      said.score = larger_or_nan(of_model, of_noise);
    }
    if (said.source == FaultSource::mpm)
      add_channels(cv, test.groups, assessment);
    assessment.cvs.push_back(said);
    assessment.flagged = assessment.flagged || *said.flagged;
    assessment.score = std::isnan(assessment.score) ? said.score : std::max(assessment.score, said.score);
    assessment.numbers.push_back({"log10_p", test.all.log_p / std::numbers::ln10, cv});
    assessment.numbers.push_back({"autoregression", static_cast<double>(test.order), cv});
    if (noise)
      assessment.numbers.push_back({"log10_p_noise", *noise / std::numbers::ln10, cv});
    for (std::size_t mv = 0; mv < test.groups.size(); ++mv)
      assessment.numbers.push_back(
          {"log10_p_channel", test.groups[mv].log_p / std::numbers::ln10, cv, static_cast<Eigen::Index>(mv)});
  }

  /// ln p of the hypothesis that this CV has the noise of the benchmark; none without a benchmark, or with
  /// too few samples.
  std::optional<double> log_p_of_noise(const Eigen::VectorXd& e, Eigen::Index cv, Eigen::Index order) const {
    if (!benchmark_)
      return std::nullopt;
    const Eigen::VectorXd good = benchmark_->row(cv).transpose();
    const Eigen::Index common =
        std::max(order, autoregression_order(good, options_.regression.largest_order));
    const auto samples = std::min(known_rows(e, common).size(), known_rows(good, common).size());
    if (static_cast<Eigen::Index>(samples) < common + 1 + kLeastFreedom)
      return std::nullopt;
    return log_p_same_autoregression(fit_autoregression(e, common), fit_autoregression(good, common));
  }

  /// Names the channel of the MV without which most is lost, and of each further MV without which something
  /// is lost (Holm over the MVs).
  void add_channels(Eigen::Index cv, const std::vector<FTest>& groups, Assessment& assessment) const {
    std::vector<double> p;
    for (const FTest& group : groups)
      p.push_back(std::exp(group.log_p));
    const std::vector<double> adjusted = holm_adjusted(p);
    const auto strongest =
        best_candidate(groups, [](const FTest& group) { return -group.log_p; }) - groups.begin();
    for (std::size_t mv = 0; mv < p.size(); ++mv)
      if (static_cast<std::ptrdiff_t>(mv) == strongest || adjusted[mv] <= options_.regression.alpha)
        assessment.flagged_channels.push_back({cv, static_cast<Eigen::Index>(mv)});
  }

  const OrderOptions& options_;
  ErrorRegressions usual_;  ///< regressions of a benchmark that has corrected the model, or empty
  std::optional<Eigen::MatrixXd> benchmark_;  ///< errors of the benchmark; none: no disturbance is flagged
};

}  // namespace

AssessmentMethodInfo order_method() {
  return {
      {.name = "order",
       .title = "order from the MVs to the simulation errors",
       .verdict = "the MVs help to predict the simulation error of some CV: a mismatch; or it has not the "
                  "colour of the benchmark: a disturbance",
       .requirements = {.moving_mvs = true, .complete_record = false},
       .locates_cvs = true,
       .names_channels = true,
       .tells_sources = true,
       .information = ModelInformation::shown,
       .numbers = {{"log10_p", NumberScope::cv, "log10 p of no MV helping to predict the error of the CV"},
                   {"autoregression", NumberScope::cv, "order of the autoregression of the error"},
                   {"log10_p_noise", NumberScope::cv,
                    "log10 p of the error having the colour and mean of that of the benchmark"},
                   {"log10_p_channel", NumberScope::channel,
                    "log10 p of this MV not helping when the others do"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Order>(context); },
      option_table<OrderOptions>(keys, "of the order test from the MVs to the simulation errors"),
      [](const MethodOptions& options) { return options.of<OrderOptions>().regression.alpha; }};
}

}  // namespace mpm
