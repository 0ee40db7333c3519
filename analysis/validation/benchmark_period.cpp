#include "analysis/validation/benchmark_period.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kFewestPresent = 0.5;  // of the most values that a signal has in any period of this length

/// The sums over the samples of a signal up to each sample, so that the sums over a period are differences.
struct RunningSums {
  Eigen::ArrayXd count, sum, squares, moves;

  explicit RunningSums(const Eigen::RowVectorXd& signal)
      : count(Eigen::ArrayXd::Zero(signal.size() + 1)), sum(count), squares(count), moves(count) {
    const auto is_there = !signal.array().isNaN();
    const double centre =
        is_there.select(signal.array(), 0.0).sum() / std::max(1.0, static_cast<double>(is_there.count()));
    double last = kNaN;
    for (Eigen::Index k = 0; k < signal.size(); ++k) {
      const bool there = !std::isnan(signal(k));
      const double value = there ? signal(k) - centre : 0.0;
      count(k + 1) = count(k) + (there ? 1.0 : 0.0);
      sum(k + 1) = sum(k) + value;
      squares(k + 1) = squares(k) + value * value;
      moves(k + 1) = moves(k) + (there && !std::isnan(last) && signal(k) != last ? 1.0 : 0.0);
      if (there)
        last = signal(k);
    }
  }

  Eigen::Index samples() const { return count.size() - 1; }
  bool is_empty() const { return count(samples()) == 0.0; }
  /// The first sample of a period does not count as a move, because the sample from which it differs lies
  /// before the period.
  bool moves_in(Eigen::Index first, Eigen::Index end) const { return moves(end) > moves(first + 1); }
  double variance(Eigen::Index first, Eigen::Index end) const {
    const double n = count(end) - count(first), mean = (sum(end) - sum(first)) / n;
    return (squares(end) - squares(first)) / n - mean * mean;
  }
  /// The most values in any period of this length.
  double most_in(Eigen::Index length) const {
    return (count.tail(count.size() - length) - count.head(count.size() - length)).maxCoeff();
  }
  /// log(variance in the period / variance of all samples); none if the signal has fewer than `fewest` values
  /// or does not vary.
  std::optional<double> log_ratio(Eigen::Index first, Eigen::Index end, double fewest) const {
    if (const double n = count(end) - count(first); n < 2.0 || n < fewest || !moves_in(first, end))
      return std::nullopt;
    const double ratio = variance(first, end) / variance(0, samples());
    return ratio > 0.0 ? std::optional(std::log(ratio)) : std::nullopt;
  }
};

std::vector<RunningSums> running_sums_of(const Eigen::Ref<const Eigen::MatrixXd>& signals) {
  std::vector<RunningSums> sums;
  for (Eigen::Index row = 0; row < signals.rows(); ++row)
    if (RunningSums of_row(signals.row(row)); !of_row.is_empty())
      sums.push_back(std::move(of_row));
  return sums;
}

}  // namespace

std::pair<Eigen::Index, Eigen::Index> quietest_period(const Eigen::Ref<const Eigen::MatrixXd>& signals,
                                                      const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                      Eigen::Index samples) {
  const std::vector<RunningSums> of_signals = running_sums_of(signals), of_inputs = running_sums_of(inputs);
  const Eigen::Index N = signals.cols();
  const auto stands_still = [N](const RunningSums& input, Eigen::Index first, Eigen::Index end) {
    return input.moves_in(0, N) && !input.moves_in(first, end);
  };
  std::pair<Eigen::Index, Eigen::Index> best{0, 0};
  if (of_signals.empty() || samples < 2 || samples > N)
    return best;
  std::vector<double> fewest;
  for (const RunningSums& signal : of_signals)
    fewest.push_back(kFewestPresent * signal.most_in(samples));
  double least = kInfinity;
  for (Eigen::Index first = 0; first + samples <= N; ++first) {
    const Eigen::Index end = first + samples;
    if (std::any_of(of_inputs.begin(), of_inputs.end(),
                    [&](const RunningSums& input) { return stands_still(input, first, end); }))
      continue;
    double volume = 0.0;
    for (std::size_t i = 0; i < of_signals.size(); ++i)
      volume += of_signals[i].log_ratio(first, end, fewest[i]).value_or(kInfinity);
    if (volume < least) {
      least = volume;
      best = {first, end};
    }
  }
  return best;
}

}  // namespace mpm
