#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/prewhitened_test.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "scenarios/toml/option_keys.hpp"

// What the methods have in common that ask whether other signals help to predict the simulation errors of
// the nominal model.

namespace mpm {

/// Of the methods that regress the simulation errors on other signals
/// (analysis/methods/shared/error_regression).
struct ErrorRegressionOptions {
  double alpha = 0.01;     ///< share of loops in which nothing is to be found that are flagged at most
  int filters = 4;         ///< Laguerre filters a signal
  double pole = 0.8;       ///< of these filters
  int largest_order = 12;  ///< of the autoregression of an error

  bool operator==(const ErrorRegressionOptions&) const = default;
};
OptionKeys keys(ErrorRegressionOptions& options);

/// e = y - y_sim of each CV, ny x N; NaN where a sample is missing, 0 where y and y_sim differ by rounding.
/// @throws InputError for an infinite value
Eigen::MatrixXd model_errors(const AssessedLoop& loop);

/// The responses of the Laguerre filters L_1 ... L_n, which have a delay of a sample and more, to each row of
/// `signals` (m x N), N x n for each: with u(k-1), u(k-2), ... they say what of the past of a signal a
/// process remembers that forgets as pole^k. In deviations from the first sample.
std::vector<Eigen::MatrixXd> filtered_signals(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                              const ErrorRegressionOptions& options);

/// filtered_signals() of signals of the whole record of a loop (m x samples of it), of which the samples of
/// the loop are kept: in a window the past before it counts.
std::vector<Eigen::MatrixXd> filtered_in_window(const AssessedLoop& loop,
                                                const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                                const ErrorRegressionOptions& options);

/// prewhitened_test() of the error of each CV on filtered signals, by the autoregression of least BIC of the
/// error alone; none for a CV with too few samples.
struct ErrorRegression {
  Autoregression whiteness;
  PrewhitenedTest test;
};
using ErrorRegressions = std::vector<std::optional<ErrorRegression>>;
ErrorRegressions error_regressions(const Eigen::MatrixXd& errors,
                                   const std::vector<Eigen::MatrixXd>& filtered,
                                   const ErrorRegressionOptions& options);

/// What signals explain of the errors of a CV beyond what they explain in the benchmark, where nothing is
/// wrong: there the errors follow the signals in what the correction by it cannot express, as the
/// characteristic of a valve is, and so they do in every other record. With F_b of the benchmark and n, n_b
/// the degrees of freedom of both autoregressions each test is that of
///
///   F / max(1, 1 + (F_b - 1) n / n_b)
///
/// The test as it is where the benchmark (`usual`, of each CV) says nothing of the CV, or all signals
/// together explain no more of it than chance does: F_b <= 1.
PrewhitenedTest new_in(const ErrorRegression& found, Eigen::Index cv, const ErrorRegressions& usual);

/// The samples without a gap that error_regressions() needs at most with so many signals.
Eigen::Index error_regression_samples(const ErrorRegressionOptions& options, Eigen::Index signals);

/// The score of a p-value among `tests`, of which one is to be below alpha by chance in a share alpha of the
/// loops at most (Bonferroni): -log10(tests p), above -log10(alpha) when it is significant. Not held at 0, so
/// that loops in which nothing is found have an order, too.
double significance_score(double log_p, double tests);

}  // namespace mpm
