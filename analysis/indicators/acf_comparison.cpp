#include "analysis/indicators/acf_comparison.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/correlation.hpp"
#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

constexpr Eigen::Index kFewestCompared = 8;  // a quarter of this is 2 lags

void require_inside(const char* name, double value, double lower, double upper) {
  if (!(value > lower && value < upper)) {
    throw InputError(name, fmt::format("{}", value), fmt::format("above {} and below {}", lower, upper));
  }
}

/// A control error or deviation with its autocorrelation.
struct Deviation {
  Eigen::VectorXd values;
  Autocorrelation acf;
};

Deviation deviation(const Signal& signal, const std::optional<Eigen::VectorXd>& y_set, Eigen::Index max_lag,
                    double confidence) {
  if (!y_set) {
    return {signal.array() - signal.mean(), autocorrelation(signal, max_lag, confidence)};
  }
  const Eigen::VectorXd error = signal - *y_set;
  return {error, autocorrelation(error, max_lag, confidence, 0.0)};
}

AcfFeatures features(const Autocorrelation& acf, const AcfComparisonOptions& options) {
  const double band_factor = simultaneous_band_factor(options.confidence, acf.values.size() - 1);
  return {decay_lag(acf, options.decay_level, band_factor),
          acf_oscillation(acf, options.oscillation_threshold), acf.values};
}

/// Returns Bartlett's half band at the decay lag, or at the last lag if the decay lag lies beyond it.
double band_at_decay(const Autocorrelation& acf, double lag) {
  if (std::isnan(lag)) {
    return lag;
  }
  const double last = static_cast<double>(acf.bartlett_band.size() - 1);
  return acf.bartlett_band[static_cast<Eigen::Index>(std::min(std::ceil(lag), last))];
}

/// Returns the cosine of the angle between two deviations from the same centre.
double coherence(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0);
}

double margin(const Deviation& y, const Deviation& y0, const AcfComparison& comparison,
              const AcfComparisonOptions& options) {
  const double rho = coherence(y.values, y0.values);
  const double band = std::hypot(band_at_decay(y.acf, comparison.y.decay_lag),
                                 band_at_decay(y0.acf, comparison.y0.decay_lag));
  const double level = options.decay_level;
  const double chance = std::sqrt(1.0 - rho * rho) * band / (level * std::abs(std::log(level)));
  return std::max(1.0 + options.decay_tolerance, std::exp(chance));
}

/// Returns the verdict on the speed. A decay lag beyond the last lag is replaced by the last lag.
LoopSpeed speed_verdict(const AcfComparison& comparison, double last_lag) {
  const double y = comparison.y.decay_lag;
  const double y0 = comparison.y0.decay_lag;
  if (std::isnan(y) || std::isnan(y0)) {
    return LoopSpeed::undetermined;
  }
  const double ratio = std::min(y, last_lag) / std::min(y0, last_lag);
  if (ratio > comparison.decay_margin) {
    return LoopSpeed::slower;
  }
  if (ratio * comparison.decay_margin < 1.0) {
    return LoopSpeed::faster;
  }
  return std::isinf(y) || std::isinf(y0) ? LoopSpeed::undetermined : LoopSpeed::alike;
}

double distance(const Autocorrelation& a, const Autocorrelation& b) {
  const Eigen::Index lags = a.values.size() - 1;
  return (a.values - b.values).tail(lags).norm() / std::sqrt(static_cast<double>(lags));
}

ErrorOrigin origin_verdict(const AcfComparison& comparison, double own_share) {
  const bool speed_differs = comparison.speed == LoopSpeed::slower || comparison.speed == LoopSpeed::faster;
  const bool differs = speed_differs || comparison.oscillates_by_error() || comparison.calmed_by_error();
  if (!differs || std::isnan(comparison.own_share)) {
    return ErrorOrigin::none;
  }
  if (comparison.own_share >= own_share) {
    return ErrorOrigin::own;
  }
  return comparison.own_share <= 1.0 - own_share ? ErrorOrigin::others : ErrorOrigin::both;
}

}  // namespace

void AcfComparisonOptions::validate() const {
  if (max_lag < 0) {
    throw InputError("largest lag", fmt::format("{}", max_lag), "0 or more");
  }
  require_inside("decay level", decay_level, 0.0, 1.0);
  require_inside("tolerance of decay lags", decay_tolerance, 0.0, kInfinity);
  require_confidence(confidence);
  require_inside("threshold of the decay ratio", oscillation_threshold, 0.0, 1.0);
  require_inside("own share", own_share, 0.5, 1.0);
}

bool AcfComparison::oscillates_by_error() const {
  return y.oscillation.verdict == Oscillation::present && y0.oscillation.verdict == Oscillation::absent;
}

bool AcfComparison::calmed_by_error() const {
  return y.oscillation.verdict == Oscillation::absent && y0.oscillation.verdict == Oscillation::present;
}

double decay_lag(const Autocorrelation& acf, double level, double band_factor) {
  if (acf.values.size() == 0 || std::isnan(acf.values[0])) {
    return kNaN;
  }
  const Eigen::ArrayXd r = acf.values.array().abs();
  const Eigen::Index lags = r.size();
  const auto end_of_run = [&](Eigen::Index lag) {
    while (lag + 1 < lags && r[lag + 1] >= level) {
      ++lag;
    }
    return lag;
  };
  Eigen::Index last = end_of_run(0);
  for (Eigen::Index lag = last + 1; lag < lags; ++lag) {
    if (r[lag] >= level) {
      const Eigen::Index end = end_of_run(lag);
      const Eigen::Index length = end - lag + 1;
      if ((r.segment(lag, length) >= band_factor * acf.bartlett_band.array().segment(lag, length)).any()) {
        last = end;
      }
      lag = end;
    }
  }
  if (last == lags - 1) {
    return kInfinity;
  }
  return static_cast<double>(last) + (r[last] - level) / (r[last] - r[last + 1]);
}

double simultaneous_band_factor(double confidence, Eigen::Index max_lag) {
  const double each = 1.0 - (1.0 - confidence) / static_cast<double>(max_lag);
  return two_sided_normal_quantile(each) / two_sided_normal_quantile(confidence);
}

AcfComparison compare_autocorrelations(const Signal& y, const Signal& y0, const Signal& y0_diag,
                                       const std::optional<Eigen::VectorXd>& y_set,
                                       const AcfComparisonOptions& options) {
  options.validate();
  require_signal("y", y, kFewestCompared);
  require_same_length("y", y, "y0", y0);
  require_same_length("y", y, "y0_diag", y0_diag);
  if (y_set) {
    require_same_length("y", y, "y_set", *y_set);
  }
  const Eigen::Index max_lag = options.max_lag > 0 ? options.max_lag : y.size() / 4;
  const Deviation of_y = deviation(y, y_set, max_lag, options.confidence);
  const Deviation of_y0 = deviation(y0, y_set, max_lag, options.confidence);
  const Deviation of_y0_diag = deviation(y0_diag, y_set, max_lag, options.confidence);

  AcfComparison result;
  result.y = features(of_y.acf, options);
  result.y0 = features(of_y0.acf, options);
  result.y0_diag = features(of_y0_diag.acf, options);
  result.white_band = of_y.acf.white_band;
  result.decay_lag_ratio = result.y.decay_lag / result.y0.decay_lag;
  result.decay_margin = margin(of_y, of_y0, result, options);
  result.speed = speed_verdict(result, static_cast<double>(max_lag));
  result.y_from_y0 = distance(of_y.acf, of_y0.acf);
  result.y_from_y0_diag = distance(of_y.acf, of_y0_diag.acf);
  result.y0_diag_from_y0 = distance(of_y0_diag.acf, of_y0.acf);
  result.own_share = result.y_from_y0_diag / (result.y_from_y0_diag + result.y0_diag_from_y0);
  result.origin = origin_verdict(result, options.own_share);
  return result;
}

}  // namespace mpm
