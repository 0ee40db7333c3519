#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/prewhitened_test.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "scenarios/toml/option_keys.hpp"

// The common part of the methods that ask whether other signals help to predict the simulation errors of the
// nominal model.

namespace mpm {

/// Options of the methods that regress the simulation errors on other signals
/// (analysis/methods/shared/error_regression).
struct ErrorRegressionOptions {
  double alpha = 0.01;     ///< largest share of loops without a fault that are flagged
  int filters = 4;         ///< number of Laguerre filters of each signal
  double pole = 0.8;       ///< pole of these filters
  int largest_order = 12;  ///< largest order of the autoregression of an error

  bool operator==(const ErrorRegressionOptions&) const = default;
};
OptionKeys keys(ErrorRegressionOptions& options);

/// e = y - y_sim of each CV, ny x N; NaN where a sample is missing, 0 where y and y_sim differ by rounding.
/// @throws InputError for an infinite value
Eigen::MatrixXd model_errors(const AssessedLoop& loop);

/// The responses of the Laguerre filters L_1 ... L_n, which delay by at least one sample, to each row of
/// `signals` (m x N): an N x n matrix for each row. They summarise u(k-1), u(k-2), ... for a process whose
/// memory decays as pole^k. The signals are taken as deviations from their first sample.
std::vector<Eigen::MatrixXd> filtered_signals(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                              const ErrorRegressionOptions& options);

/// filtered_signals() of signals of the whole record of a loop (m x samples of the record), at the samples of
/// the loop only: in a window the filters remember what was before it.
std::vector<Eigen::MatrixXd> filtered_in_window(const AssessedLoop& loop,
                                                const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                                const ErrorRegressionOptions& options);

/// prewhitened_test() of the error of each CV on filtered signals, with the autoregression of least BIC of
/// the error alone; none for a CV with too few samples.
struct ErrorRegression {
  Autoregression whiteness;
  PrewhitenedTest test;
};
using ErrorRegressions = std::vector<std::optional<ErrorRegression>>;
ErrorRegressions error_regressions(const Eigen::MatrixXd& errors,
                                   const std::vector<Eigen::MatrixXd>& filtered,
                                   const ErrorRegressionOptions& options);

/// The part of the errors of a CV that signals explain beyond what they explain in the benchmark, where
/// nothing is wrong. There the errors follow the signals in a way that the correction by the benchmark cannot
/// express, such as the characteristic of a valve, and they do so in every other record. With F_b of the
/// benchmark and n, n_b the degrees of freedom of both autoregressions, each test uses instead of F
///
///   F / max(1, 1 + (F_b - 1) n / n_b)
///
/// The test is unchanged if the benchmark (`usual`, of each CV) has no test of the CV, or if all signals
/// together explain no more of it there than chance does: F_b <= 1.
PrewhitenedTest new_in(const ErrorRegression& found, Eigen::Index cv, const ErrorRegressions& usual);

/// The largest number of samples without a gap that error_regressions() needs with so many signals.
Eigen::Index error_regression_samples(const ErrorRegressionOptions& options, Eigen::Index signals);

/// The score of a p-value among `tests` tests: -log10(tests p), significant above -log10(alpha). With no
/// fault, one of the tests is significant in a share alpha of the loops at most (Bonferroni). The score may
/// be below 0, so that loops in which nothing is found have an order, too.
double significance_score(double log_p, double tests);

}  // namespace mpm
