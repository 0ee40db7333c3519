#include "analysis/indicators/moment_scatter.hpp"

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::VectorXd>;

void require_same_samples(Eigen::Index found, Eigen::Index allowed) {
  if (found != allowed) {
    throw InputError("length of the nominal output", fmt::format("{} samples", found),
                     fmt::format("{} samples, for which the scanner was made", allowed));
  }
}

}  // namespace

MomentScatter::MomentScatter(Eigen::Index samples) {
  if (samples < kShortestWindow + kFewestCorrelatedPairs) {
    throw InputError("length of a record for moving moments", fmt::format("{} samples", samples),
                     fmt::format("{} or more", kShortestWindow + kFewestCorrelatedPairs));
  }
  y0_ = {Eigen::VectorXd(samples), Eigen::VectorXd(samples)};
  e0_ = y0_;
  y0_difference_.resize(samples);
  e0_difference_.resize(samples);
}

void MomentScatter::require(const Signal& y0, const Signal& e0, const WindowScan& windows) const {
  windows.validate();
  require_same_samples(y0.size(), samples());
  require_same_length("nominal output", y0, "nominal error", e0);
  if (windows.longest > samples() - kFewestCorrelatedPairs) {
    throw InputError(
        "longest window", fmt::format("{} samples", windows.longest),
        fmt::format("{} or less for a record of {} samples", samples() - kFewestCorrelatedPairs, samples()));
  }
}

CentredSums MomentScatter::difference_sums(const Eigen::VectorXd& z_y0, const Eigen::VectorXd& z_e0,
                                           Eigen::Index positions) {
  const Eigen::Index n = positions - 1;
  y0_difference_.head(n) = z_y0.segment(1, n) - z_y0.head(n);
  e0_difference_.head(n) = z_e0.segment(1, n) - z_e0.head(n);
  return centred_sums(y0_difference_.head(n), e0_difference_.head(n));
}

PerStatistic<CentredSums> MomentScatter::sums(const Signal& y0, const Signal& e0, int window) {
  const Eigen::Index positions = samples() - window + 1;
  moving_moments(y0, window, y0_.skewness.head(positions), y0_.kurtosis.head(positions));
  moving_moments(e0, window, e0_.skewness.head(positions), e0_.kurtosis.head(positions));
  PerStatistic<CentredSums> sums;
  sums.kts = centred_sums(y0_.kurtosis.head(positions), e0_.kurtosis.head(positions));
  sums.skn = centred_sums(y0_.skewness.head(positions), e0_.skewness.head(positions));
  sums.dkts = difference_sums(y0_.kurtosis, e0_.kurtosis, positions);
  sums.dskn = difference_sums(y0_.skewness, e0_.skewness, positions);
  return sums;
}

PerStatistic<CentredSums> MomentScatter::at(const Signal& y0, const Signal& e0, int window) {
  require(y0, e0, {window, window, 1});
  return sums(y0, e0, window);
}

}  // namespace mpm
