#include "analysis/validation/benchmark_period.hpp"

#include <cmath>
#include <vector>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kFewestPresent = 0.5;  // of the samples of a period

/// Sums over the samples of a CV up to each, so that those of a period are differences.
struct RunningSums {
  Eigen::ArrayXd count, sum, squares;

  explicit RunningSums(const Eigen::RowVectorXd& signal)
      : count(Eigen::ArrayXd::Zero(signal.size() + 1)), sum(count), squares(count) {
    for (Eigen::Index k = 0; k < signal.size(); ++k) {
      const bool there = !std::isnan(signal(k));
      count(k + 1) = count(k) + (there ? 1.0 : 0.0);
      sum(k + 1) = sum(k) + (there ? signal(k) : 0.0);
      squares(k + 1) = squares(k) + (there ? signal(k) * signal(k) : 0.0);
    }
  }

  /// NaN with too few samples.
  double variance(Eigen::Index first, Eigen::Index end) const {
    const double n = count(end) - count(first);
    if (n < kFewestPresent * static_cast<double>(end - first) || n < 2.0)
      return kNaN;
    const double mean = (sum(end) - sum(first)) / n;
    return (squares(end) - squares(first)) / n - mean * mean;
  }
};

}  // namespace

std::pair<Eigen::Index, Eigen::Index> quietest_period(const AssessedLoop& loop, Eigen::Index samples) {
  std::vector<RunningSums> errors;
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
    errors.emplace_back(loop.y.row(cv) - loop.y_sim.row(cv));
  std::pair<Eigen::Index, Eigen::Index> best{0, 0};
  double least = kInfinity;
  for (Eigen::Index first = 0; first + samples <= loop.samples(); ++first) {
    double volume = 0.0;
    bool any = false;
    for (const RunningSums& error : errors) {
      const double ratio = error.variance(first, first + samples) / error.variance(0, loop.samples());
      if (!(ratio > 0.0))
        continue;
      volume += std::log(ratio);
      any = true;
    }
    if (any && volume < least) {
      least = volume;
      best = {first, first + samples};
    }
  }
  return best;
}

}  // namespace mpm
