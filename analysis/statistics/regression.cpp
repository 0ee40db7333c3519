#include "analysis/statistics/regression.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kFewestPairs = 3.0;
constexpr std::size_t kFewestClusters = 5;           // in a sample, and in a resample
constexpr double kExact = 1e-12;                     // 1 - R^2 within the rounding of the sums
constexpr double kLargestCorrelation = 1.0 - 1e-15;  // where Fisher's z is still finite

/// The sums over a set of pairs from which a line is fitted. Adding two gives the sums of the union.
struct Sums {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(double dx, double dy) { *this += {1.0, dx, dy, dx * dx, dx * dy, dy * dy}; }

  Sums& operator+=(const Sums& other) {
    n += other.n;
    x += other.x;
    y += other.y;
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
  }

  Sums operator-(const Sums& o) const { return {n - o.n, x - o.x, y - o.y, xx - o.xx, xy - o.xy, yy - o.yy}; }
};

/// The point about which the sums are taken: the medians. The distance from mean to median is at most one
/// standard deviation, so that the centred sums of the whole set lose no more than one bit. One outlier does
/// not move the medians away from the bulk of the pairs; if it did, a resample without that pair would suffer
/// from cancellation.
struct Centre {
  double x = 0.0;
  double y = 0.0;
};

/// Returns the indices of the pairs without a NaN or an infinity, in the order of their clusters.
std::vector<Eigen::Index> finite_pairs(const Signal& x, const Signal& y,
                                       std::span<const std::int64_t> cluster) {
  std::vector<Eigen::Index> pairs;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i]))
      pairs.push_back(i);
  std::stable_sort(pairs.begin(), pairs.end(), [cluster](Eigen::Index one, Eigen::Index other) {
    return cluster[static_cast<std::size_t>(one)] < cluster[static_cast<std::size_t>(other)];
  });
  return pairs;
}

double median(const Signal& values, const std::vector<Eigen::Index>& pairs) {
  std::vector<double> sorted;
  sorted.reserve(pairs.size());
  for (const Eigen::Index i : pairs)
    sorted.push_back(values[i]);
  std::sort(sorted.begin(), sorted.end());
  return sorted_quantile(sorted, 0.5);
}

/// Returns `square` - n mean^2, or 0 if this is within the rounding of the sums or of the values themselves.
double centred(double n, double square, double mean, double centre) {
  const double value = square - n * mean * mean;
  const double rounding = 4.0 * kEpsilon * std::abs(centre);
  return value <= 4.0 * n * kEpsilon * square || value <= n * rounding * rounding ? 0.0 : value;
}

LinearFit line(const Sums& sums, const Centre& centre) {
  LinearFit fit;
  fit.pairs = static_cast<Eigen::Index>(sums.n);
  if (sums.n < kFewestPairs) {
    return fit;
  }
  const double mean_x = sums.x / sums.n;
  const double mean_y = sums.y / sums.n;
  const double xx = centred(sums.n, sums.xx, mean_x, centre.x);
  const double yy = centred(sums.n, sums.yy, mean_y, centre.y);
  const double xy = sums.xy - sums.n * mean_x * mean_y;
  if (xx > 0.0) {
    fit.slope = xy / xx;
    fit.intercept = (centre.y + mean_y) - fit.slope * (centre.x + mean_x);
    const double r_squared = yy > 0.0 ? (xy / xx) * (xy / yy) : kNaN;
    fit.r_squared = r_squared > 1.0 - kExact ? 1.0 : r_squared;
  }
  return fit;
}

/// The pairs in the form that a fit needs: the sums of each cluster, in the order of the cluster numbers.
struct ClusterSums {
  Centre centre;
  std::vector<Sums> clusters;

  ClusterSums(const Signal& x, const Signal& y, std::span<const std::int64_t> cluster) {
    const std::vector<Eigen::Index> pairs = finite_pairs(x, y, cluster);
    if (pairs.empty())
      return;
    centre = {median(x, pairs), median(y, pairs)};
    std::optional<std::int64_t> last;
    for (const Eigen::Index i : pairs) {
      if (const std::int64_t number = cluster[static_cast<std::size_t>(i)]; last != number) {
        clusters.emplace_back();
        last = number;
      }
      clusters.back().add(x[i] - centre.x, y[i] - centre.y);
    }
  }
};

/// The results of a fit, transformed so that they scatter evenly: R^2 becomes Fisher's z = artanh r.
struct Results {
  double slope, intercept, z;

  bool are_finite() const { return std::isfinite(slope) && std::isfinite(intercept) && std::isfinite(z); }
};

Results results_of(const LinearFit& fit) {
  const double r = std::copysign(std::sqrt(fit.r_squared), fit.slope);
  return {fit.slope, fit.intercept, std::atanh(std::clamp(r, -kLargestCorrelation, kLargestCorrelation))};
}

/// Returns the standard errors of the results from the influence of each cluster on them (the infinitesimal
/// jackknife). A cluster counts as often as it was drawn.
///
/// With the means mx, my and the centred sums Sxx, Sxy, Syy of all pairs, the sums sxx, sxy, syy of a cluster
/// about mx and my, and the sum e of its residuals about the line:
///
///   I(slope) = (sxy - slope sxx)/Sxx,   I(intercept) = e/n - mx I(slope),
///   I(z) = r (sxy/Sxy - sxx/(2 Sxx) - syy/(2 Syy))/(1 - r^2)
Results standard_errors(const std::vector<Sums>& clusters, const std::vector<int>& times, const Sums& all,
                        const Centre& centre, const LinearFit& fit) {
  const double mx = all.x / all.n, my = all.y / all.n;
  const double Sxx = all.xx - all.n * mx * mx, Syy = all.yy - all.n * my * my, Sxy = all.xy - all.n * mx * my;
  const double r = Sxy / std::sqrt(Sxx * Syy);
  Results squares{0.0, 0.0, 0.0};
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const Sums& of = clusters[c];
    const double xx = of.xx - 2.0 * mx * of.x + of.n * mx * mx;
    const double yy = of.yy - 2.0 * my * of.y + of.n * my * my;
    const double xy = of.xy - mx * of.y - my * of.x + of.n * mx * my;
    const double e = (of.y - of.n * my) - fit.slope * (of.x - of.n * mx);
    const double slope = (xy - fit.slope * xx) / Sxx;
    const double intercept = e / all.n - (centre.x + mx) * slope;
    const double z = r * (xy / Sxy - 0.5 * xx / Sxx - 0.5 * yy / Syy) / (1.0 - r * r);
    squares.slope += times[c] * slope * slope;
    squares.intercept += times[c] * intercept * intercept;
    squares.z += times[c] * z * z;
  }
  return {std::sqrt(squares.slope), std::sqrt(squares.intercept), std::sqrt(squares.z)};
}

/// Returns the standard errors from the fits that leave out each cluster in turn (the jackknife). If a few
/// clusters determine the line, the jackknife sees more than the influences do.
Results jackknife_errors(const std::vector<Sums>& clusters, const Sums& all, const Centre& centre) {
  const auto without = [&](const Sums& cluster) { return results_of(line(all - cluster, centre)); };
  const auto count = static_cast<double>(clusters.size());
  const auto error_of = [&](double Results::*member) {
    double sum = 0.0, squares = 0.0;
    for (const Sums& cluster : clusters)
      sum += without(cluster).*member;
    for (const Sums& cluster : clusters) {
      const double distance = without(cluster).*member - sum / count;
      squares += distance * distance;
    }
    return std::sqrt(squares * (count - 1.0) / count);
  };
  return {error_of(&Results::slope), error_of(&Results::intercept), error_of(&Results::z)};
}

/// The studentised results of the resamples, (result of the resample - result)/standard error of the
/// resample.
struct Studentised {
  std::vector<double> slope, intercept, z;
};

/// Returns the number of clusters in a resample: half of all clusters, but at least kFewestClusters.
std::size_t resample_size(std::size_t clusters) {
  return std::max((clusters + 1) / 2, kFewestClusters);
}

/// Adds one resample, unless it has no line, or all its pairs lie on the line, so that there is no standard
/// error.
void add_resample(const std::vector<Sums>& clusters, const Centre& centre, const Results& results,
                  RandomStream& stream, Studentised& studentised) {
  std::vector<int> times(clusters.size(), 0);
  Sums all;
  for (std::size_t i = 0; i < resample_size(clusters.size()); ++i) {
    const auto drawn = static_cast<std::size_t>(stream.below(clusters.size()));
    ++times[drawn];
    all += clusters[drawn];
  }
  const LinearFit fit = line(all, centre);
  const Results again = results_of(fit);
  if (!again.are_finite() || fit.r_squared == 1.0)
    return;
  const Results errors = standard_errors(clusters, times, all, centre, fit);
  const Results t{(again.slope - results.slope) / errors.slope,
                  (again.intercept - results.intercept) / errors.intercept, (again.z - results.z) / errors.z};
  if (!t.are_finite())
    return;
  studentised.slope.push_back(t.slope);
  studentised.intercept.push_back(t.intercept);
  studentised.z.push_back(t.z);
}

Interval studentised_interval(double result, double error, std::vector<double>& t, double confidence) {
  std::sort(t.begin(), t.end());
  return {result - error * sorted_quantile(t, (1.0 + confidence) / 2.0),
          result - error * sorted_quantile(t, (1.0 - confidence) / 2.0)};
}

/// Returns the range of R^2 over an interval of z.
Interval r_squared_interval(const Interval& z) {
  const double lower = std::tanh(z.lower), upper = std::tanh(z.upper);
  const double least = lower <= 0.0 && upper >= 0.0 ? 0.0 : std::min(lower * lower, upper * upper);
  return {least, std::max(lower * lower, upper * upper)};
}

Sums sum_of(const std::vector<Sums>& clusters) {
  Sums all;
  for (const Sums& cluster : clusters)
    all += cluster;
  return all;
}

LinearFit fit_all(const std::vector<Sums>& clusters, const Centre& centre, Eigen::Index given) {
  LinearFit fit = line(sum_of(clusters), centre);
  fit.left_out = given - fit.pairs;
  return fit;
}

}  // namespace

void ClusterBootstrapOptions::validate() const {
  if (replications < 100) {
    throw InputError("bootstrap replications", fmt::format("{}", replications), "100 or more");
  }
  require_confidence(confidence);
}

LinearFit linear_fit(const Signal& x, const Signal& y) {
  require_same_length("x", x, "y", y);
  const std::vector<std::int64_t> one(static_cast<std::size_t>(x.size()), 0);
  const ClusterSums sums(x, y, one);
  return fit_all(sums.clusters, sums.centre, x.size());
}

LinearFitIntervals cluster_bootstrap(const Signal& x, const Signal& y, std::span<const std::int64_t> cluster,
                                     RandomStream& stream, const ClusterBootstrapOptions& options) {
  require_same_length("x", x, "y", y);
  if (static_cast<Eigen::Index>(cluster.size()) != x.size()) {
    throw InputError("number of cluster numbers", fmt::format("{}", cluster.size()),
                     fmt::format("{}, one a pair", x.size()));
  }
  options.validate();

  LinearFitIntervals result;
  result.slope = result.intercept = result.r_squared = {kNaN, kNaN};
  const ClusterSums sums(x, y, cluster);
  const auto& [centre, clusters] = sums;
  result.fit = fit_all(clusters, centre, x.size());
  result.clusters = static_cast<Eigen::Index>(clusters.size());
  const Results results = results_of(result.fit);
  if (clusters.size() < kFewestClusters || !results.are_finite())
    return result;
  if (result.fit.r_squared == 1.0) {  // all resamples have the same line
    result.slope = {results.slope, results.slope};
    result.intercept = {results.intercept, results.intercept};
    result.r_squared = {1.0, 1.0};
    return result;
  }

  Studentised t;
  for (int i = 0; i < options.replications; ++i)
    add_resample(clusters, centre, results, stream, t);
  result.replications_used = static_cast<int>(t.slope.size());
  if (2 * result.replications_used >= options.replications) {
    const Results errors = jackknife_errors(clusters, sum_of(clusters), centre);
    result.slope = studentised_interval(results.slope, errors.slope, t.slope, options.confidence);
    result.intercept =
        studentised_interval(results.intercept, errors.intercept, t.intercept, options.confidence);
    result.r_squared = r_squared_interval(studentised_interval(results.z, errors.z, t.z, options.confidence));
  }
  return result;
}

}  // namespace mpm
