#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/indicators/moment_scatter.hpp"
#include "analysis/indicators/mpm_indicator.hpp"
#include "base/non_finite.hpp"
#include "base/row.hpp"

namespace mpm {

/// Chapter 5: means over the window lengths of a scan, for one statistic Z. With a, b and alpha of
/// `principal_axes` for each window length, and alpha folded into 0 ... 45 degrees,
///
/// | symbol     | member | definition | unit |
/// |------------|--------|------------|------|
/// | co_Z       | co     | mean of |corr|                       (5.15), (5.21) | 1 |
/// | ce_Z       | ce     | mean of (alpha/45) sqrt(1 - b/a)     (5.18), (5.22) | 1 |
/// | mean alpha_Z | angle | mean of alpha                       (5.16), (5.19) | degrees |
/// | -          | unfolded_angle | the same without the folding, 0 ... 90     | degrees |
/// | mean DR_Z  | minor_to_major | mean of b/a, 0 ... 1        (5.17), (5.20) | 1 |
///
/// The print has a/b in (5.17), but tables 5.3 to 5.5 have values below 1 only: b/a. It divides only (5.15)
/// by the number of window lengths; means are meant. Folding is demanded for ce alone; no mean angle of the
/// 32 in those tables exceeds 45 degrees, so `angle` is folded too.
struct ScatterMeans {
  double co = kNaN;
  double ce = kNaN;
  double angle = kNaN;
  double unfolded_angle = kNaN;
  double minor_to_major = kNaN;
  /// Number of window lengths in the means: those that have a correlation, see `MpmScanner::scan`.
  int used = 0;
};

/// Chapter 2: shape of the scatter at one window length, for one statistic Z (tables 2.5, 2.10, 2.11).
///
/// | symbol    | member           | definition | unit |
/// |-----------|------------------|------------|------|
/// | gamma     | inclination      | |angle| of `principal_axes`, 0 ... 90, not folded | degrees |
/// | a/b       | major_to_minor   | 1 or more; these tables have values up to 6.14 | 1 |
/// | alpha     | regression_angle | |atan of the slope of e0 on y0|, 0 ... 90 | degrees |
/// | |log(R^2)| | log_r_squared   | |ln r^2|, infinite for r = 0 | 1 |
///
/// Chapter 2 does not fold: it tabulates inclinations of 53.59, 60.11 and 64.00 degrees. It tabulates no
/// negative angle although under a disturbance either sign is as likely, so these are magnitudes.
struct ScatterShape {
  double inclination = kNaN;
  double major_to_minor = kNaN;
  double regression_angle = kNaN;
  double log_r_squared = kNaN;
};

/// The shape of one scatter, with y0 on the x axis. The four numbers rest on two, the correlation and the
/// ratio of the standard deviations; 25 of the 28 lines of tables 2.10 and 2.11 have that relation to
/// rounding (plain covariance, root of the eigenvalues, natural logarithm), a 26th with 90 degrees less its
/// inclination.
///
/// All members are NaN without a correlation: fewer than kFewestCorrelatedPairs pairs, or a member that does
/// not vary.
ScatterShape scatter_shape(const CentredSums& sums);

/// All indicators of chapters 2, 5 and 6 that rest on the distribution of nominal output and nominal error in
/// moving windows, for one controlled variable.
struct DistributionIndicators {
  /// Chapter 5, from y0_diag and e0_diag.
  PerStatistic<ScatterMeans> means;
  /// Chapter 6: I_MPM and its parts, from the same scan.
  MpmIndicator mpm;
  /// Chapter 2, from y0 and e0 at one window length.
  PerStatistic<ScatterShape> shape;
  /// y0_diag and e0_diag at that window length: `confidence_ellipse` of these draws figures 5.11, 5.12, 5.19
  /// and 5.20.
  PerStatistic<CentredSums> scatter_diag;
};

/// Computes `DistributionIndicators` for records of one length; holds the memory for it, so that a
/// computation allocates nothing. One scanner a thread.
class DistributionScanner {
 public:
  /// @throws InputError when `samples` is below kShortestWindow + kFewestCorrelatedPairs
  explicit DistributionScanner(Eigen::Index samples) : scatter_(samples), e0_(samples) {}

  /// The indicators of one controlled variable, in one scan over the window lengths.
  ///
  /// | symbol  | meaning | shape | unit |
  /// |---------|---------|-------|------|
  /// | y       | measured output | N | any |
  /// | y0      | nominal output, chapter 2 | N | the same |
  /// | y0_diag | nominal diagonal output, chapters 5 and 6 | N | the same |
  /// | window  | one window length, for chapter 2 and for the ellipses of chapter 5 | - | samples |
  ///
  /// The ellipses of the thesis have the prediction horizon as their window length (section 5.3.1).
  /// Nominal errors are e0 = y0 - y (2.21), (5.4) and e0_diag = y0_diag - y (5.11). Chapter 3 has y - y0:
  /// that leaves every kurtosis, changes the sign of every skewness, and so changes no indicator.
  /// @throws InputError as `MomentScatter::scan`
  DistributionIndicators compute(const Eigen::Ref<const Eigen::VectorXd>& y,
                                 const Eigen::Ref<const Eigen::VectorXd>& y0,
                                 const Eigen::Ref<const Eigen::VectorXd>& y0_diag, const WindowScan& windows,
                                 int window);

 private:
  MomentScatter scatter_;
  Eigen::VectorXd e0_;
};

/// Every indicator, named quantity_statistic: co_dkts, angle_kts, regression_angle_skn, ..., and i_mpm.
std::vector<Row<DistributionIndicators>> distribution_rows();

/// `scatter_diag`, named scatter_quantity_statistic: the numbers of a confidence ellipse.
std::vector<Row<DistributionIndicators>> scatter_rows();

}  // namespace mpm
