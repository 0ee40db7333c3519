#include "analysis/methods/shared/error_regression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/identification/decorrelation.hpp"
#include "analysis/statistics/f_distribution.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// Errors up to this share of the largest y are rounding, such as those of a loop without noise and fault.
constexpr double kErrorResolution = 1e-10;

}  // namespace

OptionKeys keys(ErrorRegressionOptions& options) {
  return {key::number("alpha", options.alpha, NumberRule::inside(0, 1),
                      "largest probability that a loop without a fault is flagged, over all its CVs"),
          key::whole("filters", options.filters, 1, 100, "number of Laguerre filters of each signal"),
          key::number("pole", options.pole, NumberRule::below_one(),
                      "pole of the Laguerre filters: their memory decays by this factor from sample to "
                      "sample. 0 is a finite impulse response"),
          key::whole("largest_order", options.largest_order, 0, 100,
                     "largest order of the autoregression of a simulation error; BIC chooses")};
}

Eigen::MatrixXd model_errors(const AssessedLoop& loop) {
  Eigen::MatrixXd e = loop.y - loop.y_sim;
  if (e.array().isInf().any())
    throw InputError("simulation errors", "an infinite value",
                     "finite values, and NaN where a sample is missing");
  for (Eigen::Index cv = 0; cv < e.rows(); ++cv) {
    double largest_error = 0.0;
    for (const double value : e.row(cv))
      if (!std::isnan(value))
        largest_error = std::max(largest_error, std::abs(value));
    if (largest_error <= kErrorResolution * loop.y_sim.row(cv).cwiseAbs().maxCoeff())
      e.row(cv) = e.row(cv).array().isNaN().select(e.row(cv), 0.0);
  }
  return e;
}

std::vector<Eigen::MatrixXd> filtered_signals(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                              const ErrorRegressionOptions& options) {
  std::vector<Eigen::MatrixXd> filtered;
  for (Eigen::Index row = 0; row < signals.rows(); ++row) {
    const Eigen::RowVectorXd moves = signals.row(row).array() - signals(row, 0);
    filtered.emplace_back(
        laguerre_responses(moves, options.filters + 1, options.pole).rightCols(options.filters));
  }
  return filtered;
}

std::vector<Eigen::MatrixXd> filtered_in_window(const AssessedLoop& loop,
                                                const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                                const ErrorRegressionOptions& options) {
  std::vector<Eigen::MatrixXd> filtered = filtered_signals(signals, options);
  for (Eigen::MatrixXd& group : filtered)
    group = Eigen::MatrixXd(group.middleRows(loop.first, loop.samples()));
  return filtered;
}

ErrorRegressions error_regressions(const Eigen::MatrixXd& errors,
                                   const std::vector<Eigen::MatrixXd>& filtered,
                                   const ErrorRegressionOptions& options) {
  const Eigen::Index regressors = options.filters * static_cast<Eigen::Index>(filtered.size());
  ErrorRegressions regressions(static_cast<std::size_t>(errors.rows()));
  for (Eigen::Index cv = 0; cv < errors.rows(); ++cv) {
    const Eigen::VectorXd e = errors.row(cv).transpose();
    const Eigen::Index order = autoregression_order(e, options.largest_order);
    const auto known = static_cast<Eigen::Index>(known_rows(e, order).size());
    if (known < order + 1 + regressors + kLeastFreedom)
      continue;
    const Autoregression whiteness = fit_autoregression(e, order);
    regressions[static_cast<std::size_t>(cv)] = {whiteness, prewhitened_test(e, filtered, whiteness)};
  }
  return regressions;
}

PrewhitenedTest new_in(const ErrorRegression& found, Eigen::Index cv, const ErrorRegressions& usual) {
  const auto place = static_cast<std::size_t>(cv);
  PrewhitenedTest test = found.test;
  if (place >= usual.size() || !usual[place] || usual[place]->test.all.f <= 1.0)
    return test;
  const ErrorRegression& benchmark = *usual[place];
  const auto n = static_cast<double>(found.whiteness.freedom());
  const double longer = n / static_cast<double>(benchmark.whiteness.freedom());
  const double denominator = n - static_cast<double>(found.test.all.freedom);
  const auto discount = [&](FTest& of, const FTest& in_benchmark) {
    if (of.freedom == 0)
      return;
    of.f /= std::max(1.0, 1.0 + (in_benchmark.f - 1.0) * longer);
    of.log_p = log_f_tail(of.f, static_cast<double>(of.freedom), denominator);
  };
  discount(test.all, benchmark.test.all);
  // Signals from outside that move in only one of the two records form different groups.
  if (test.groups.size() == benchmark.test.groups.size())
    for (std::size_t group = 0; group < test.groups.size(); ++group)
      discount(test.groups[group], benchmark.test.groups[group]);
  return test;
}

Eigen::Index error_regression_samples(const ErrorRegressionOptions& options, Eigen::Index signals) {
  return options.filters * signals + 2 * options.largest_order + 1 + kLeastFreedom;
}

double significance_score(double log_p, double tests) {
  return -(log_p + std::log(tests)) / std::numbers::ln10;
}

}  // namespace mpm
