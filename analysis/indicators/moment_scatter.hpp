#pragma once

#include <Eigen/Core>

#include "analysis/statistics/correlation.hpp"
#include "analysis/statistics/moving_moments.hpp"
#include "scenarios/study/window_scan.hpp"

namespace mpm {

/// A variation of a moment below this value is only numerical error. Moments are of the order of 1 to 10 and
/// have the relative error kMovingMomentAccuracy.
inline constexpr double kMomentResolution = 100.0 * kMovingMomentAccuracy;

/// One T for each statistic Z of a moving window that the thesis uses.
///
/// | symbol | member | meaning |
/// |--------|--------|---------|
/// | kts    | kts    | kurtosis |
/// | skn    | skn    | skewness |
/// | dkts   | dkts   | first difference of the kurtosis from one window to the next |
/// | dskn   | dskn   | first difference of the skewness |
///
/// `d/dt` in (5.19) to (5.22), (6.13), (6.14) is this first difference: the factor 1/Ts stretches both axes
/// equally and changes neither correlation nor angle nor ratio.
template <class T>
struct PerStatistic {
  T kts{}, skn{}, dkts{}, dskn{};
};

/// Computes the scatter of (Z of y0, Z of e0) over the windows of one length: statistics of the nominal
/// output are on the x axis, those of the nominal error on the y axis. It holds the memory for this, so that
/// a computation allocates nothing; each thread needs its own.
///
/// The axes are those of the thesis, as its numbers show. Under a disturbance alone its ellipses lie along
/// the horizontal axis (section 5.3.1, figure 5.11), and the statistic that varies more is the kurtosis of
/// the nominal output, with a peak at each step of the setpoint. docs/methods.md has the evidence.
class MomentScatter {
 public:
  /// @throws InputError when `samples` is below kShortestWindow + kFewestCorrelatedPairs, the shortest usable
  /// record
  explicit MomentScatter(Eigen::Index samples);

  /// Length of the records.
  Eigen::Index samples() const { return y0_.skewness.size(); }

  /// Returns the sums over the windows of `window` samples. Windows in which either signal stands still have
  /// no moments, and pairs that contain them are left out.
  ///
  /// | symbol | meaning | shape | unit |
  /// |--------|---------|-------|------|
  /// | y0     | nominal output, x axis | N | any |
  /// | e0     | nominal error y0 - y, y axis | N | the same |
  ///
  /// @throws InputError for signals whose length is not `samples()` or with values that are not finite, and
  ///   for a window outside kShortestWindow ... N - kFewestCorrelatedPairs
  PerStatistic<CentredSums> at(const Eigen::Ref<const Eigen::VectorXd>& y0,
                               const Eigen::Ref<const Eigen::VectorXd>& e0, int window);

  /// Calls `visit(sums)` with `at(y0, e0, window)` for each window length of `windows`, the shortest first.
  /// This is the one scan behind all indicators of chapters 5 and 6.
  /// @throws InputError as `at`, before the first call, and for an invalid scan
  template <class Visit>
  void scan(const Eigen::Ref<const Eigen::VectorXd>& y0, const Eigen::Ref<const Eigen::VectorXd>& e0,
            const WindowScan& windows, Visit visit) {
    require(y0, e0, windows);
    for (int window = windows.shortest; window <= windows.longest; window += windows.stride) {
      visit(sums(y0, e0, window));
    }
  }

 private:
  /// Skewness and kurtosis of one signal in the windows of one length.
  struct Moments {
    Eigen::VectorXd skewness;
    Eigen::VectorXd kurtosis;
  };

  void require(const Eigen::Ref<const Eigen::VectorXd>& y0, const Eigen::Ref<const Eigen::VectorXd>& e0,
               const WindowScan& windows) const;
  PerStatistic<CentredSums> sums(const Eigen::Ref<const Eigen::VectorXd>& y0,
                                 const Eigen::Ref<const Eigen::VectorXd>& e0, int window);
  CentredSums difference_sums(const Eigen::VectorXd& z_y0, const Eigen::VectorXd& z_e0,
                              Eigen::Index positions);

  Moments y0_;
  Moments e0_;
  Eigen::VectorXd y0_difference_;
  Eigen::VectorXd e0_difference_;
};

}  // namespace mpm
