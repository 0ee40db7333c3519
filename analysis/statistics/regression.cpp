#include "analysis/statistics/regression.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kFewestPairs = 3.0;

struct Pair {
  double x;
  double y;
  std::int64_t cluster;
};

/// What a line needs to know about a set of pairs. Adding two gives the sums of the union.
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
};

/// The point the sums are taken about: the medians. The distance from mean to median is at most one standard
/// deviation, so that the centred sums of the whole set lose no more than one bit; and one wild pair does not
/// move it away from the bulk, which a resample without that pair would feel as cancellation.
struct Centre {
  double x = 0.0;
  double y = 0.0;
};

std::vector<Pair> finite_pairs(const Signal& x, const Signal& y, std::span<const std::int64_t> cluster) {
  std::vector<Pair> pairs;
  pairs.reserve(static_cast<std::size_t>(x.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(y[i])) {
      pairs.push_back({x[i], y[i], cluster[static_cast<std::size_t>(i)]});
    }
  }
  return pairs;
}

Centre medians(const std::vector<Pair>& pairs) {
  std::vector<double> x, y;
  for (const Pair& pair : pairs) {
    x.push_back(pair.x);
    y.push_back(pair.y);
  }
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  return {sorted_quantile(x, 0.5), sorted_quantile(y, 0.5)};
}

/// `square` - n mean^2, or 0 when that is within the rounding of the sums or of the values themselves.
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
    fit.r_squared = yy > 0.0 ? std::min(1.0, (xy / xx) * (xy / yy)) : kNaN;
  }
  return fit;
}

/// The sums of each cluster, in the order of the cluster numbers.
std::vector<Sums> sums_by_cluster(const std::vector<Pair>& pairs, const Centre& centre) {
  std::map<std::int64_t, Sums> by_number;
  for (const Pair& pair : pairs) {
    by_number[pair.cluster].add(pair.x - centre.x, pair.y - centre.y);
  }
  std::vector<Sums> sums;
  sums.reserve(by_number.size());
  for (const auto& [number, cluster_sums] : by_number) {
    sums.push_back(cluster_sums);
  }
  return sums;
}

LinearFit resample(const std::vector<Sums>& clusters, const Centre& centre, RandomStream& stream) {
  Sums sums;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    sums += clusters[stream.below(clusters.size())];
  }
  return line(sums, centre);
}

Interval percentile_interval(std::vector<double>& values, double confidence) {
  std::sort(values.begin(), values.end());
  return {sorted_quantile(values, (1.0 - confidence) / 2.0),
          sorted_quantile(values, (1.0 + confidence) / 2.0)};
}

LinearFit fit_all(const std::vector<Sums>& clusters, const Centre& centre, Eigen::Index given) {
  Sums all;
  for (const Sums& cluster : clusters) {
    all += cluster;
  }
  LinearFit fit = line(all, centre);
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
  const std::vector<Pair> pairs = finite_pairs(x, y, cluster);
  const Centre centre = pairs.empty() ? Centre{} : medians(pairs);
  const std::vector<Sums> clusters = sums_by_cluster(pairs, centre);
  result.fit = fit_all(clusters, centre, x.size());
  result.clusters = static_cast<Eigen::Index>(clusters.size());
  if (clusters.size() < 2) {
    return result;
  }

  std::vector<double> slopes, intercepts, r_squared;
  for (int i = 0; i < options.replications; ++i) {
    const LinearFit fit = resample(clusters, centre, stream);
    if (std::isfinite(fit.slope) && std::isfinite(fit.r_squared)) {
      slopes.push_back(fit.slope);
      intercepts.push_back(fit.intercept);
      r_squared.push_back(fit.r_squared);
    }
  }
  result.replications_used = static_cast<int>(slopes.size());
  if (2 * result.replications_used >= options.replications) {
    result.slope = percentile_interval(slopes, options.confidence);
    result.intercept = percentile_interval(intercepts, options.confidence);
    result.r_squared = percentile_interval(r_squared, options.confidence);
  }
  return result;
}

}  // namespace mpm
