#include "analysis/indicators/mpm_indicator.hpp"

#include <algorithm>
#include <cmath>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

}  // namespace

void MpmMeans::Magnitude::add(const CentredSums& sums) {
  const double correlation = pearson_correlation(sums, kFewestCorrelatedPairs, kMomentResolution);
  if (!std::isnan(correlation)) {
    sum_ += std::abs(correlation);
    ++count_;
  }
}

double MpmMeans::Magnitude::value() const {
  return count_ > 0 ? sum_ / count_ : kNaN;
}

void MpmMeans::add(const PerStatistic<CentredSums>& sums) {
  co_.kts.add(sums.kts);
  co_.skn.add(sums.skn);
  co_.dkts.add(sums.dkts);
  co_.dskn.add(sums.dskn);
  ++scanned_;
}

MpmIndicator MpmMeans::result() const {
  MpmIndicator result;
  result.co_dkts = co_.dkts.value();
  result.co_dskn = co_.dskn.value();
  result.i_mpm = std::fmax(result.co_dkts, result.co_dskn);  // fmax of a number and a NaN is the number
  result.co_kts = co_.kts.value();
  result.co_skn = co_.skn.value();
  result.scanned = scanned_;
  result.used = std::min({co_.dkts.count(), co_.dskn.count(), co_.kts.count(), co_.skn.count()});
  return result;
}

MpmIndicator MpmScanner::scan(const Signal& y0_diag, const Signal& e0_diag, const WindowScan& windows) {
  MpmMeans means;
  scatter_.scan(y0_diag, e0_diag, windows,
                [&means](const PerStatistic<CentredSums>& sums) { means.add(sums); });
  return means.result();
}

}  // namespace mpm
