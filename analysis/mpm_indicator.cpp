#include "analysis/mpm_indicator.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/correlation.hpp"
#include "analysis/moving_moments.hpp"
#include "analysis/signal_check.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

constexpr int kShortestWindow = 3;  // two samples have skewness 0 and kurtosis 1, whatever they are

/// Variation of a moment below which it is only error. Moments are of the order of 1 to 10 and have the
/// relative error kMovingMomentAccuracy.
constexpr double kMomentResolution = 100.0 * kMovingMomentAccuracy;

/// The mean of those |correlations| that exist.
class MeanMagnitude {
 public:
  void add(double correlation) {
    if (!std::isnan(correlation)) {
      sum_ += std::abs(correlation);
      ++count_;
    }
  }
  int count() const { return count_; }
  double value() const { return count_ > 0 ? sum_ / count_ : std::numeric_limits<double>::quiet_NaN(); }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

void require_same_samples(Eigen::Index found, Eigen::Index allowed) {
  if (found != allowed) {
    throw InputError("length of y0_diag", fmt::format("{} samples", found),
                     fmt::format("{} samples, for which the scanner was made", allowed));
  }
}

}  // namespace

void WindowScan::validate() const {
  if (shortest < kShortestWindow) {
    throw InputError("shortest window", fmt::format("{} samples", shortest),
                     fmt::format("{} or more", kShortestWindow));
  }
  if (longest < shortest) {
    throw InputError("longest window", fmt::format("{} samples", longest),
                     fmt::format("{} (the shortest window) or more", shortest));
  }
  if (stride < 1) {
    throw InputError("stride of the window lengths", fmt::format("{} samples", stride), "1 or more");
  }
}

WindowScan default_window_scan(int prediction_horizon) {
  constexpr int kShortestHorizon = 2 * kShortestWindow - 1;
  if (prediction_horizon < kShortestHorizon) {
    throw InputError("prediction horizon", fmt::format("{} samples", prediction_horizon),
                     fmt::format("{} or more for a scan of moving windows", kShortestHorizon));
  }
  return {(prediction_horizon + 1) / 2, 2 * prediction_horizon, 1};
}

MpmScanner::MpmScanner(Eigen::Index samples) {
  if (samples < kShortestWindow + kFewestCorrelatedPairs) {
    throw InputError("length of a record for I_MPM", fmt::format("{} samples", samples),
                     fmt::format("{} or more", kShortestWindow + kFewestCorrelatedPairs));
  }
  y0_ = {Eigen::VectorXd(samples), Eigen::VectorXd(samples)};
  e0_ = y0_;
  y0_difference_.resize(samples);
  e0_difference_.resize(samples);
}

double MpmScanner::raw_correlation(const Eigen::VectorXd& z_y0, const Eigen::VectorXd& z_e0,
                                   Eigen::Index positions) const {
  return pearson_correlation(z_y0.head(positions), z_e0.head(positions), kFewestCorrelatedPairs,
                             kMomentResolution);
}

double MpmScanner::difference_correlation(const Eigen::VectorXd& z_y0, const Eigen::VectorXd& z_e0,
                                          Eigen::Index positions) {
  const Eigen::Index n = positions - 1;
  y0_difference_.head(n) = z_y0.segment(1, n) - z_y0.head(n);
  e0_difference_.head(n) = z_e0.segment(1, n) - z_e0.head(n);
  return pearson_correlation(y0_difference_.head(n), e0_difference_.head(n), kFewestCorrelatedPairs,
                             kMomentResolution);
}

MpmIndicator MpmScanner::scan(const Signal& y0_diag, const Signal& e0_diag, const WindowScan& windows) {
  const Eigen::Index samples = y0_.skewness.size();
  windows.validate();
  require_same_samples(y0_diag.size(), samples);
  require_same_length("y0_diag", y0_diag, "e0_diag", e0_diag);
  if (windows.longest > samples - kFewestCorrelatedPairs) {
    throw InputError(
        "longest window", fmt::format("{} samples", windows.longest),
        fmt::format("{} or less for a record of {} samples", samples - kFewestCorrelatedPairs, samples));
  }

  MeanMagnitude co_dkts, co_dskn, co_kts, co_skn;
  for (int window = windows.shortest; window <= windows.longest; window += windows.stride) {
    const Eigen::Index positions = samples - window + 1;
    moving_moments(y0_diag, window, y0_.skewness.head(positions), y0_.kurtosis.head(positions));
    moving_moments(e0_diag, window, e0_.skewness.head(positions), e0_.kurtosis.head(positions));
    co_kts.add(raw_correlation(y0_.kurtosis, e0_.kurtosis, positions));
    co_skn.add(raw_correlation(y0_.skewness, e0_.skewness, positions));
    co_dkts.add(difference_correlation(y0_.kurtosis, e0_.kurtosis, positions));
    co_dskn.add(difference_correlation(y0_.skewness, e0_.skewness, positions));
  }

  MpmIndicator result;
  result.co_dkts = co_dkts.value();
  result.co_dskn = co_dskn.value();
  result.i_mpm = std::fmax(result.co_dkts, result.co_dskn);  // of a number and a NaN, fmax takes the number
  result.co_kts = co_kts.value();
  result.co_skn = co_skn.value();
  result.scanned = windows.count();
  result.used = std::min({co_dkts.count(), co_dskn.count(), co_kts.count(), co_skn.count()});
  return result;
}

MpmIndicator mpm_indicator(const Signal& y0_diag, const Signal& e0_diag, const WindowScan& windows) {
  return MpmScanner(y0_diag.size()).scan(y0_diag, e0_diag, windows);
}

}  // namespace mpm
