#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "analysis/statistics/interval.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// Limits of the generalised eigenvalues.
enum class VariabilityLimits : std::int8_t {
  published = 0,     ///< for one direction that is chosen beforehand (`variance_ratio_limits`)
  largest_root = 1,  ///< for all directions at once (`largest_root_limits`)
};

/// Options of `compare_variability`.
struct VariabilityOptions {
  /// Confidence of the limits of each eigenvalue (2.10), (2.11) and of the angles (2.14). The thesis takes
  /// 0.95.
  double confidence = 0.95;
  /// Largest lag of the sum (2.9); 0: all lags, as the thesis prints it. All lags overstate the sum and so
  /// widen the limits (`autocorrelation_factor`): a change is then called significant too rarely.
  Eigen::Index largest_lag = 0;
  /// The eigenvectors are the directions in which the two records differ most. With the published limits, two
  /// records with the same statistics are therefore too often called different, and so are the CVs near these
  /// directions.
  VariabilityLimits limits = VariabilityLimits::published;

  /// @throws InputError unless 0 < confidence < 1 and largest_lag >= 0
  void validate() const;
  bool operator==(const VariabilityOptions&) const = default;
};

/// Change of the variability along a direction, or of one CV.
enum class VariabilityChange : std::int8_t {
  none = 0,    ///< 1 lies within the limits
  worse = 1,   ///< both limits lie above 1
  better = 2,  ///< both limits lie below 1
};

template <>
inline constexpr auto kWords<VariabilityChange> = word_list("none", "worse", "better");

/// One generalised eigenvector (2.8).
struct VariabilityDirection {
  double mu = kNaN;           ///< ratio of the variances along it
  Eigen::VectorXd p;          ///< ny; unit length
  double f_benchmark = kNaN;  ///< f_I of (2.9)
  double f_monitored = kNaN;  ///< f_II of (2.9)
  Interval limits;  ///< of mu (VariabilityLimits). If the records are too short, the upper limit is +infinity
                    ///< and, with `largest_root`, the lower limit is 0
  VariabilityChange change = VariabilityChange::none;
};

enum class VariabilityStatus : std::int8_t {
  ok = 0,
  /// The control errors of the benchmark are linearly dependent. Some direction then has no variance to
  /// compare with, and I_v has none to divide by. All other results are missing.
  singular_benchmark = 1,
};

template <>
inline constexpr auto kWords<VariabilityStatus> = word_list("ok", "singular benchmark");

/// The result of a comparison of a monitored period with a benchmark period.
struct VariabilityComparison {
  VariabilityStatus status = VariabilityStatus::ok;
  double i_v = kNaN;                             ///< I_v (2.7), the product of all mu
  std::vector<VariabilityDirection> directions;  ///< ny of them, mu descending
  Eigen::VectorXd cos_worse;                     ///< cos theta^w (2.12) of each CV
  Eigen::VectorXd cos_better;                    ///< cos theta^b (2.13) of each CV
  /// The limit of the cosines (2.14): a CV with a cosine above it is responsible for the change. A CV may be
  /// responsible for both kinds of change.
  double beta = kNaN;
};

/// Compares the variability of the control errors of two periods, after Yu and Qin (2008), section 2.2.2 and
/// appendix A1.3 of the thesis:
///
///   I_v = det cov(e_II) / det cov(e_I)       (2.7)
///   cov(e_II) p = mu cov(e_I) p              (2.8)
///
/// with limits of each mu from the autocorrelation of the errors along p (2.9 to 2.11; or the limits of
/// VariabilityLimits::largest_root), and the CVs near the subspaces of those p whose mu is significantly
/// above or below 1 (2.12 to 2.14; (2.13) is printed with P_w instead of P_b).
///
/// | symbol    | name               | meaning                                  | shape     | unit  |
/// |-----------|--------------------|------------------------------------------|-----------|-------|
/// | e_I, e_II | benchmark, monitored | control errors y - y_set of the periods | ny x ns_d | of CV |
///
/// The periods may differ in length. mu, I_v and the limits do not depend on the units of the CVs, nor on any
/// other linear map of the errors; the angles do. A constant offset has no covariance and is not seen.
/// @throws InputError for no CV, fewer than 2 samples, different numbers of CVs, values that are not finite,
///   and invalid options
VariabilityComparison compare_variability(const Eigen::Ref<const Eigen::MatrixXd>& benchmark,
                                          const Eigen::Ref<const Eigen::MatrixXd>& monitored,
                                          const VariabilityOptions& options = {});

}  // namespace mpm
