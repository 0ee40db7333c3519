#include "analysis/statistics/moving_moments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

constexpr double kUnitRoundoff = std::numeric_limits<double>::epsilon() / 2.0;
/// Below this variance, m2^2 would leave the range of double precision.
constexpr double kSmallestVariance = 1e-150;

/// Factor of the error bound. Let r = max(S4/n)/m2^2, with the maximum over the windows since the centre was
/// set, k the number of additions since then and u the unit roundoff. Then every power sum obeys |error of
/// S_l|/n <= k u (r m2^2)^(l/4). Through the formulas of `central_moments` this becomes at most 39 k u r in
/// m4/m2^2, 13 k u r in m3/m2^1.5 and 3 k u r in m2/m2, hence 45 k u r in the stated errors. Evaluating the
/// formulas adds less than 110 u r, and k is at least 4 whenever the bound is used. Divisions take most of
/// the time here, so 1/n is computed once and the bound is compared without a division.
constexpr double kErrorFactor = 80.0;

struct CentralMoments {
  double m2;
  double m3;
  double m4;
};

/// Sums of the powers 1 to 4 of the deviations from a centre, over one window.
class PowerSums {
 public:
  explicit PowerSums(Eigen::Index window) : window_(window), share_(1.0 / static_cast<double>(window)) {}

  /// Sums over the window that starts at `first`, about the mean of that window.
  void anchor(const Signal& signal, Eigen::Index first) {
    const auto samples = signal.segment(first, window_);
    centre_ = samples.mean();
    s1_ = s2_ = s3_ = s4_ = 0.0;
    for (const double x : samples) {
      add(x, 1.0);
    }
    additions_ = static_cast<double>(window_);
    peak_ = s4_;
  }

  /// Moves the window on by one sample.
  void slide(double leaving, double entering) {
    add(entering, 1.0);
    peak_ = std::max(peak_, s4_);  // the sums are largest with both samples in them
    add(leaving, -1.0);
    additions_ += 2.0;
  }

  CentralMoments central_moments() const {
    const double d = s1_ * share_;
    const double a2 = s2_ * share_;
    const double a3 = s3_ * share_;
    const double a4 = s4_ * share_;
    const double dd = d * d;
    return {a2 - dd, a3 - 3.0 * d * a2 + 2.0 * d * dd, a4 - 4.0 * d * a3 + 6.0 * dd * a2 - 3.0 * dd * dd};
  }

  /// Returns whether the bound above keeps the results within the stated accuracy. False for a NaN or m2 <=
  /// 0.
  bool accurate(double m2) const {
    return m2 > kSmallestVariance &&
           kErrorFactor * kUnitRoundoff * additions_ * (peak_ * share_) <= kMovingMomentAccuracy * (m2 * m2);
  }

 private:
  void add(double x, double sign) {
    const double a = x - centre_;
    const double aa = a * a;
    s1_ += sign * a;
    s2_ += sign * aa;
    s3_ += sign * (aa * a);
    s4_ += sign * (aa * aa);
  }

  Eigen::Index window_;
  double share_;  // weight of a sample, 1/n
  double centre_ = 0.0;
  double s1_ = 0.0, s2_ = 0.0, s3_ = 0.0, s4_ = 0.0;
  double additions_ = 0.0;  // since the centre was set
  double peak_ = 0.0;       // largest sum of fourth powers since the centre was set
};

void check(const Signal& signal, Eigen::Index window, Eigen::Index skewness, Eigen::Index kurtosis) {
  require_signal("signal", signal, 2);
  if (window < 2 || window > signal.size()) {
    throw InputError("window length", fmt::format("{}", window), fmt::format("2 to {}", signal.size()));
  }
  const Eigen::Index positions = signal.size() - window + 1;
  if (skewness != positions || kurtosis != positions) {
    throw InputError("lengths of skewness and kurtosis", fmt::format("{} and {}", skewness, kurtosis),
                     fmt::format("{} for {} samples in windows of {}", positions, signal.size(), window));
  }
}

}  // namespace

void moving_moments(const Signal& signal, Eigen::Index window, Eigen::Ref<Eigen::VectorXd> skewness,
                    Eigen::Ref<Eigen::VectorXd> kurtosis) {
  check(signal, window, skewness.size(), kurtosis.size());
  const double floor = std::max(variance_floor(signal), kSmallestVariance);
  PowerSums sums(window);
  sums.anchor(signal, 0);
  for (Eigen::Index first = 0; first < skewness.size(); ++first) {
    if (first > 0) {
      sums.slide(signal[first - 1], signal[first + window - 1]);
    }
    CentralMoments m = sums.central_moments();
    if (first > 0 && !sums.accurate(m.m2)) {
      sums.anchor(signal, first);
      m = sums.central_moments();
    }
    const bool flat = m.m2 <= floor;
    skewness[first] = flat ? kNaN : m.m3 / (m.m2 * std::sqrt(m.m2));
    kurtosis[first] = flat ? kNaN : m.m4 / (m.m2 * m.m2);
  }
}

}  // namespace mpm
