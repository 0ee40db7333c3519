#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/indicators/moment_scatter.hpp"
#include "analysis/indicators/mpm_indicator.hpp"
#include "base/non_finite.hpp"
#include "base/row.hpp"

namespace mpm {

/// Chapter 5: means over the window lengths of a scan, for one statistic Z. a, b and alpha are those of
/// `principal_axes` at each window length, with alpha folded into 0 ... 45 degrees.
///
/// | symbol     | member | definition | unit |
/// |------------|--------|------------|------|
/// | co_Z       | co     | mean of |corr|                       (5.15), (5.21) | 1 |
/// | ce_Z       | ce     | mean of (alpha/45) sqrt(1 - b/a)     (5.18), (5.22) | 1 |
/// | mean alpha_Z | angle | mean of alpha                       (5.16), (5.19) | degrees |
/// | -          | unfolded_angle | mean of alpha without folding, 0 ... 90    | degrees |
/// | mean DR_Z  | minor_to_major | mean of b/a, 0 ... 1        (5.17), (5.20) | 1 |
///
/// The thesis prints a/b in (5.17), but tables 5.3 to 5.5 have only values below 1, which are b/a. It divides
/// only (5.15) by the number of window lengths, although all are means. It demands folding for ce alone; but
/// none of the 32 mean angles in those tables exceeds 45 degrees, so `angle` is folded too.
struct ScatterMeans {
  double co = kNaN;
  double ce = kNaN;
  double angle = kNaN;
  double unfolded_angle = kNaN;
  double minor_to_major = kNaN;
  /// Number of window lengths in the means. Only lengths with a correlation count, see `MpmScanner::scan`.
  int used = 0;
};

/// Chapter 2: the shape of the scatter at one window length, for one statistic Z (tables 2.5, 2.10, 2.11).
///
/// | symbol    | member           | definition | unit |
/// |-----------|------------------|------------|------|
/// | gamma     | inclination      | |angle| of `principal_axes`, 0 ... 90, not folded | degrees |
/// | a/b       | major_to_minor   | 1 or more; these tables have values up to 6.14 | 1 |
/// | alpha     | regression_angle | |atan of the slope of e0 on y0|, 0 ... 90 | degrees |
/// | |log(R^2)| | log_r_squared   | |ln r^2|, infinite for r = 0 | 1 |
///
/// Chapter 2 does not fold: its tables have inclinations of 53.59, 60.11 and 64.00 degrees. They have no
/// negative angle, although under a disturbance both signs are equally likely, so these are magnitudes.
struct ScatterShape {
  double inclination = kNaN;
  double major_to_minor = kNaN;
  double regression_angle = kNaN;
  double log_r_squared = kNaN;
};

/// Returns the shape of one scatter, with y0 on the x axis. The four numbers follow from only two: the
/// correlation and the ratio of the standard deviations. In tables 2.10 and 2.11, 25 of the 28 rows satisfy
/// this relation to rounding (plain covariance, root of the eigenvalues, natural logarithm); a 26th does so
/// with 90 degrees less its inclination.
///
/// All members are NaN if there is no correlation: fewer than kFewestCorrelatedPairs pairs, or y0 or e0 does
/// not vary.
ScatterShape scatter_shape(const CentredSums& sums);

/// All indicators of chapters 2, 5 and 6 that are computed from the distributions of nominal output and
/// nominal error in moving windows, for one controlled variable.
struct DistributionIndicators {
  /// Chapter 5, from y0_diag and e0_diag.
  PerStatistic<ScatterMeans> means;
  /// Chapter 6: I_MPM and its parts, from the same scan.
  MpmIndicator mpm;
  /// Chapter 2, from y0 and e0 at one window length.
  PerStatistic<ScatterShape> shape;
  /// From y0_diag and e0_diag at that window length. `confidence_ellipse` of these sums gives figures 5.11,
  /// 5.12, 5.19 and 5.20.
  PerStatistic<CentredSums> scatter_diag;
};

/// Computes `DistributionIndicators` for records of one length. It holds the memory for this, so that a
/// computation allocates nothing; each thread needs its own scanner.
class DistributionScanner {
 public:
  /// @throws InputError when `samples` is below kShortestWindow + kFewestCorrelatedPairs
  explicit DistributionScanner(Eigen::Index samples) : scatter_(samples), e0_(samples) {}

  /// Computes the indicators of one controlled variable in one scan over the window lengths.
  ///
  /// | symbol  | meaning | shape | unit |
  /// |---------|---------|-------|------|
  /// | y       | measured output | N | any |
  /// | y0      | nominal output, chapter 2 | N | the same |
  /// | y0_diag | nominal diagonal output, chapters 5 and 6 | N | the same |
  /// | window  | one window length, for chapter 2 and for the ellipses of chapter 5 | - | samples |
  ///
  /// The ellipses of the thesis have the prediction horizon as their window length (section 5.3.1). The
  /// nominal errors are e0 = y0 - y (2.21), (5.4) and e0_diag = y0_diag - y (5.11). Chapter 3 has y - y0,
  /// which leaves every kurtosis as it is and changes the sign of every skewness, so that no indicator
  /// changes.
  /// @throws InputError as `MomentScatter::scan`
  DistributionIndicators compute(const Eigen::Ref<const Eigen::VectorXd>& y,
                                 const Eigen::Ref<const Eigen::VectorXd>& y0,
                                 const Eigen::Ref<const Eigen::VectorXd>& y0_diag, const WindowScan& windows,
                                 int window);

 private:
  MomentScatter scatter_;
  Eigen::VectorXd e0_;
};

/// Returns a row for every indicator, named quantity_statistic: co_dkts, angle_kts, regression_angle_skn,
/// ..., and i_mpm.
std::vector<Row<DistributionIndicators>> distribution_rows();

/// Returns rows for `scatter_diag`, named scatter_quantity_statistic: the numbers behind a confidence
/// ellipse.
std::vector<Row<DistributionIndicators>> scatter_rows();

}  // namespace mpm
