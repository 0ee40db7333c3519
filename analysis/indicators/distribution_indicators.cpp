#include "analysis/indicators/distribution_indicators.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "analysis/indicators/scatter_ellipse.hpp"
#include "analysis/statistics/signal_check.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

double correlation(const CentredSums& sums) {
  return pearson_correlation(sums, kFewestCorrelatedPairs, kMomentResolution);
}

/// Accumulates `ScatterMeans`.
class ScatterSum {
 public:
  void add(const CentredSums& sums) {
    const double r = correlation(sums);
    if (std::isnan(r)) {
      return;
    }
    const PrincipalAxes axes = principal_axes(sums);
    const double folded = folded_angle(axes.angle);
    const double ratio = axes.minor / axes.major;
    sum_.co += std::abs(r);
    sum_.ce += folded / 45.0 * std::sqrt(1.0 - ratio);
    sum_.angle += folded;
    sum_.unfolded_angle += std::abs(axes.angle);
    sum_.minor_to_major += ratio;
    ++sum_.used;
  }

  ScatterMeans mean() const {
    if (sum_.used == 0) {
      return {};
    }
    const double n = sum_.used;
    return {sum_.co / n, sum_.ce / n, sum_.angle / n, sum_.unfolded_angle / n, sum_.minor_to_major / n,
            sum_.used};
  }

 private:
  ScatterMeans sum_{0.0, 0.0, 0.0, 0.0, 0.0, 0};
};

/// Applies `map` to each statistic.
template <class To, class From, class Map>
PerStatistic<To> transformed(const PerStatistic<From>& from, Map map) {
  return {map(from.kts), map(from.skn), map(from.dkts), map(from.dskn)};
}

template <class Part>
struct Statistic {
  const char* name;
  const char* meaning;
  Part PerStatistic<Part>::*member;
};

template <class Part>
constexpr std::array<Statistic<Part>, 4> kStatistics{{
    {"kts", "the moving kurtosis", &PerStatistic<Part>::kts},
    {"skn", "the moving skewness", &PerStatistic<Part>::skn},
    {"dkts", "the differences of the moving kurtosis", &PerStatistic<Part>::dkts},
    {"dskn", "the differences of the moving skewness", &PerStatistic<Part>::dskn},
}};

template <class Part>
struct Quantity {
  const char* name;
  const char* unit;
  const char* meaning;
  double Part::*member;
};

constexpr std::array<Quantity<ScatterMeans>, 5> kMeans{{
    {"co", "1", "mean absolute correlation (5.15), (5.21)", &ScatterMeans::co},
    {"ce", "1", "mean ellipse indicator (5.18), (5.22)", &ScatterMeans::ce},
    {"angle", "degrees", "mean ellipse angle folded into 0 to 45 (5.16), (5.19)", &ScatterMeans::angle},
    {"unfolded_angle", "degrees", "mean ellipse angle, 0 to 90", &ScatterMeans::unfolded_angle},
    {"minor_to_major", "1", "mean diameter ratio b/a (5.17), (5.20)", &ScatterMeans::minor_to_major},
}};

constexpr std::array<Quantity<ScatterShape>, 4> kShapes{{
    {"inclination", "degrees", "ellipse inclination at one window length", &ScatterShape::inclination},
    {"major_to_minor", "1", "diameter ratio a/b at one window length", &ScatterShape::major_to_minor},
    {"regression_angle", "degrees", "angle of the line of e0 on y0 at one window length",
     &ScatterShape::regression_angle},
    {"log_r_squared", "1", "|ln R^2| of that line", &ScatterShape::log_r_squared},
}};

constexpr std::array<Quantity<CentredSums>, 5> kSums{{
    {"scatter_mean_y0", "1", "mean over the nominal output", &CentredSums::mean_x},
    {"scatter_mean_e0", "1", "mean over the nominal error", &CentredSums::mean_y},
    {"scatter_y0_y0", "1", "sum of squares over the nominal output", &CentredSums::xx},
    {"scatter_y0_e0", "1", "sum of products of nominal output and error", &CentredSums::xy},
    {"scatter_e0_e0", "1", "sum of squares over the nominal error", &CentredSums::yy},
}};

constexpr double kMostPairs = 1e15;  // exactly representable as a double

using DistributionRows = std::vector<Row<DistributionIndicators>>;

/// Copies the means of the correlations, which are stored twice: `MpmMeans` and `ScatterSum` add up the same
/// numbers.
void copy_correlations(DistributionIndicators& indicators) {
  indicators.mpm.co_kts = indicators.means.kts.co;
  indicators.mpm.co_skn = indicators.means.skn.co;
  indicators.mpm.co_dkts = indicators.means.dkts.co;
  indicators.mpm.co_dskn = indicators.means.dskn.co;
}

/// Appends a row for each quantity of each statistic of one part of the indicators.
template <class Part, std::size_t n>
void append(DistributionRows& rows, PerStatistic<Part> DistributionIndicators::*part,
            const std::array<Quantity<Part>, n>& quantities) {
  for (const Statistic<Part>& statistic : kStatistics<Part>) {
    for (const Quantity<Part>& quantity : quantities) {
      const auto lens = path(part, statistic.member, quantity.member);
      rows.push_back(value_row<double, DistributionIndicators>(
          {std::string(quantity.name) + "_" + statistic.name,
           std::string(quantity.meaning) + ", of " + statistic.meaning, quantity.unit},
          lens, [lens](DistributionIndicators& indicators, double value) {
            lens(indicators) = value;
            copy_correlations(indicators);
          }));
    }
  }
}

}  // namespace

ScatterShape scatter_shape(const CentredSums& sums) {
  const double r = correlation(sums);
  if (std::isnan(r)) {
    return {};
  }
  const PrincipalAxes axes = principal_axes(sums);
  ScatterShape shape;
  shape.inclination = std::abs(axes.angle);
  shape.major_to_minor = axes.major / axes.minor;
  shape.regression_angle = std::abs(std::atan(sums.xy / sums.xx)) * 180.0 / std::numbers::pi;
  shape.log_r_squared = std::abs(2.0 * std::log(std::abs(r)));
  return shape;
}

DistributionIndicators DistributionScanner::compute(const Signal& y, const Signal& y0, const Signal& y0_diag,
                                                    const WindowScan& windows, int window) {
  require_same_length("y", y, "y0", y0);
  require_same_length("y", y, "y0_diag", y0_diag);
  DistributionIndicators result;
  e0_ = y0 - y;  // (2.21)
  result.shape = transformed<ScatterShape>(scatter_.at(y0, e0_, window), scatter_shape);

  e0_ = y0_diag - y;  // (5.11)
  result.scatter_diag = scatter_.at(y0_diag, e0_, window);
  MpmMeans mpm;
  PerStatistic<ScatterSum> sum;
  scatter_.scan(y0_diag, e0_, windows, [&](const PerStatistic<CentredSums>& sums) {
    mpm.add(sums);
    sum.kts.add(sums.kts);
    sum.skn.add(sums.skn);
    sum.dkts.add(sums.dkts);
    sum.dskn.add(sums.dskn);
  });
  result.mpm = mpm.result();
  result.means = transformed<ScatterMeans>(sum, [](const ScatterSum& part) { return part.mean(); });
  return result;
}

std::vector<Row<DistributionIndicators>> distribution_rows() {
  DistributionRows rows;
  append(rows, &DistributionIndicators::means, kMeans);
  append(rows, &DistributionIndicators::shape, kShapes);
  rows.push_back(
      member_row<double, DistributionIndicators>({"i_mpm", "I_MPM = max(co_dkts, co_dskn) (6.15)"},
                                                 path(&DistributionIndicators::mpm, &MpmIndicator::i_mpm)));
  return rows;
}

std::vector<Row<DistributionIndicators>> scatter_rows() {
  DistributionRows rows;
  for (const Statistic<CentredSums>& statistic : kStatistics<CentredSums>) {
    const auto pairs = path(&DistributionIndicators::scatter_diag, statistic.member, &CentredSums::pairs);
    rows.push_back(value_row<double, DistributionIndicators>(
        {std::string("scatter_pairs_") + statistic.name,
         std::string("number of windows behind the ellipse, of ") + statistic.meaning},
        pairs, [pairs](DistributionIndicators& indicators, double value) {
          // A number that cannot be a count (from a damaged file) is read as 0 windows.
          const bool count = value >= 0.0 && value <= kMostPairs;
          pairs(indicators) = count ? static_cast<Eigen::Index>(value) : 0;
        }));
  }
  append(rows, &DistributionIndicators::scatter_diag, kSums);
  return rows;
}

}  // namespace mpm
