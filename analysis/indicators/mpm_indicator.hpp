#pragma once

#include <Eigen/Core>

#include "analysis/indicators/moment_scatter.hpp"
#include "base/non_finite.hpp"

namespace mpm {

/// How similarly the distributions of nominal output and nominal error change with time.
///
/// | symbol  | meaning | range |
/// |---------|---------|-------|
/// | co_dkts | mean |corr| of the first differences of the moving kurtosis, (6.13) | 0 ... 1 or NaN |
/// | co_dskn | the same for the moving skewness, (6.14) | 0 ... 1 or NaN |
/// | i_mpm   | I_MPM = max(co_dkts, co_dskn), (6.15); of a number and a NaN, the number | 0 ... 1 or NaN |
/// | co_kts, co_skn | the same means without differentiation, (5.15) | 0 ... 1 or NaN |
struct MpmIndicator {
  double co_dkts = kNaN;
  double co_dskn = kNaN;
  double i_mpm = kNaN;
  double co_kts = kNaN;
  double co_skn = kNaN;
  /// Number of window lengths scanned.
  int scanned = 0;
  /// Number of window lengths behind the mean with the fewest; less than `scanned` if signals stand still.
  int used = 0;
};

/// Accumulates the means of `MpmIndicator`, one window length after the other.
class MpmMeans {
 public:
  /// Adds the scatter of one window length to the means.
  void add(const PerStatistic<CentredSums>& sums);
  /// Returns the indicator for the window lengths added so far.
  MpmIndicator result() const;

 private:
  /// The mean of those |correlations| that exist.
  class Magnitude {
   public:
    void add(const CentredSums& sums);
    int count() const { return count_; }
    double value() const;

   private:
    double sum_ = 0.0;
    int count_ = 0;
  };

  PerStatistic<Magnitude> co_;
  int scanned_ = 0;
};

/// Computes `MpmIndicator` for signals of one length. It holds the memory for this, so that a computation
/// allocates nothing; each thread needs its own scanner.
class MpmScanner {
 public:
  /// @throws InputError when `samples` is below kShortestWindow + kFewestCorrelatedPairs, the shortest usable
  /// record
  explicit MpmScanner(Eigen::Index samples) : scatter_(samples) {}

  /// Computes the indicators of one controlled variable, (6.13) to (6.15), from the signals that the text of
  /// the thesis means (in print, (6.13) lacks the subscript diag):
  ///
  ///   co_dZ = (1/n_MW) sum over MW of |corr(d/dt Z^MW of e0_diag, d/dt Z^MW of y0_diag)|,   Z = kts, skn
  ///
  /// The derivative is the first difference; its factor 1/Ts cancels in the correlation.
  ///
  /// Windows in which either signal stands still have no moments, and the pairs that contain them are left
  /// out. A window length has no correlation, and is left out of the mean, if fewer than
  /// kFewestCorrelatedPairs pairs are left or if a moment varies by no more than its numerical error. A mean
  /// over no window length is NaN.
  ///
  /// | symbol  | meaning | shape | unit |
  /// |---------|---------|-------|------|
  /// | y0_diag | nominal diagonal output, one controlled variable | N | any |
  /// | e0_diag | nominal error y0_diag - y, (6.9) | N | the same |
  ///
  /// @throws InputError for signals whose length is not `samples` or with values that are not finite, for an
  ///   invalid scan, and for longest > N - kFewestCorrelatedPairs
  MpmIndicator scan(const Eigen::Ref<const Eigen::VectorXd>& y0_diag,
                    const Eigen::Ref<const Eigen::VectorXd>& e0_diag, const WindowScan& windows);

 private:
  MomentScatter scatter_;
};

}  // namespace mpm
