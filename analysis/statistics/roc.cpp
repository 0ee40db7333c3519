#include "analysis/statistics/roc.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Scores = std::span<const double>;

/// Returns the point halfway between two scores, even if their sum would overflow. It never equals the upper
/// score.
double between(double upper, double lower) {
  if (std::isinf(lower) || std::isinf(upper))
    return lower;
  const double middle = lower + 0.5 * (upper - lower);
  return middle < upper ? middle : lower;
}

double share(std::int64_t hits, std::int64_t total) {
  return total > 0 ? static_cast<double>(hits) / static_cast<double>(total) : kNaN;
}

/// The numbers of positives and negatives above some threshold.
struct Above {
  std::int64_t positives = 0, negatives = 0;
};

RocPoint point(double threshold, const Above& above, std::int64_t positives, std::int64_t negatives) {
  return {threshold, share(above.positives, positives), share(above.negatives, negatives),
          share(above.positives, above.positives + above.negatives)};
}

/// Several lists in descending order, read as one list of all their scores.
class Merged {
 public:
  explicit Merged(const std::vector<SortedScores>& lists) {
    for (const SortedScores& list : lists)
      left_.emplace_back(*list.descending);
  }

  /// Returns the largest score that is left; -infinity at the end.
  double next() const {
    double largest = -kInfinity;
    for (const Scores& list : left_)
      if (!list.empty())
        largest = std::max(largest, list.front());
    return largest;
  }
  /// Takes the scores that are not below `score` and returns how many there were.
  std::int64_t take(double score) {
    std::int64_t taken = 0;
    for (Scores& list : left_)
      for (; !list.empty() && list.front() >= score; ++taken)
        list = list.subspan(1);
    return taken;
  }

 private:
  std::vector<Scores> left_;
};

std::vector<double> without_nan(Scores scores) {
  std::vector<double> kept;
  std::copy_if(scores.begin(), scores.end(), std::back_inserter(kept),
               [](double score) { return !std::isnan(score); });
  return kept;
}

SortedScores resample(const std::vector<double>& scores, RandomStream& stream) {
  std::vector<double> drawn(scores.size());
  for (double& score : drawn)
    score = scores[stream.below(scores.size())];
  return SortedScores(std::move(drawn));
}

}  // namespace

SortedScores::SortedScores(std::vector<double> scores)
    : left_out(
          static_cast<std::int64_t>(std::erase_if(scores, [](double score) { return std::isnan(score); }))) {
  std::sort(scores.begin(), scores.end(), std::greater<>());
  descending = std::make_shared<const std::vector<double>>(std::move(scores));
}

void RocCurve::each(const std::function<void(const RocPoint&)>& visit) const {
  if (!defined())
    return;
  Merged positive(positive_scores), negative(negative_scores);
  Above above;
  visit(point(kInfinity, above, positives, negatives));
  while (above.positives + above.negatives < positives + negatives) {
    const double score = std::max(positive.next(), negative.next());
    above.positives += positive.take(score);  // equal scores pass together
    above.negatives += negative.take(score);
    const bool last = above.positives + above.negatives == positives + negatives;
    const double threshold = last ? -kInfinity : between(score, std::max(positive.next(), negative.next()));
    visit(point(threshold, above, positives, negatives));
  }
}

RocCurve roc_curve(std::vector<SortedScores> positive_scores, std::vector<SortedScores> negative_scores) {
  RocCurve curve;
  curve.positive_scores = std::move(positive_scores);
  curve.negative_scores = std::move(negative_scores);
  for (const SortedScores& scores : curve.positive_scores) {
    curve.positives += std::ssize(*scores.descending);
    curve.left_out += scores.left_out;
  }
  for (const SortedScores& scores : curve.negative_scores) {
    curve.negatives += std::ssize(*scores.descending);
    curve.left_out += scores.left_out;
  }
  if (curve.defined())
    curve.area = curve.average_precision = 0.0;
  RocPoint before{};
  curve.each([&](const RocPoint& now) {
    if (curve.size++ == 0)
      curve.best = before = now;
    curve.area += (now.false_positive_rate - before.false_positive_rate) * 0.5 *
                  (now.true_positive_rate + before.true_positive_rate);
    const double recall = now.true_positive_rate - before.true_positive_rate;
    curve.average_precision +=
        recall > 0.0 ? recall * now.precision : 0.0;  // no precision at the first point
    if (now.youden() > curve.best.youden())
      curve.best = now;
    before = now;
  });
  return curve;
}

RocCurve roc_curve(Scores positive_scores, Scores negative_scores) {
  return roc_curve({SortedScores({positive_scores.begin(), positive_scores.end()})},
                   {SortedScores({negative_scores.begin(), negative_scores.end()})});
}

RocPoint roc_point(Scores positive_scores, Scores negative_scores, double threshold) {
  const std::vector<double> positives = without_nan(positive_scores);
  const std::vector<double> negatives = without_nan(negative_scores);
  const auto above = [threshold](const std::vector<double>& scores) {
    return std::count_if(scores.begin(), scores.end(), [=](double score) { return score > threshold; });
  };
  return point(threshold, {above(positives), above(negatives)}, std::ssize(positives), std::ssize(negatives));
}

Interval area_interval(double area, std::int64_t positives, std::int64_t negatives, double confidence) {
  if (!(area >= 0.0 && area <= 1.0))
    throw InputError("area under the curve", fmt::format("{}", area), "0 to 1");
  if (positives < 1 || negatives < 1)
    throw InputError("numbers of positives and negatives", fmt::format("{} and {}", positives, negatives),
                     "1 or more each");
  const double z = two_sided_normal_quantile(confidence);
  const auto m = static_cast<double>(positives);
  const auto n = static_cast<double>(negatives);
  const double others = 0.5 * (m + n) - 1.0;
  const auto inside = [&](double a) {
    const double variance =
        a * (1.0 - a) / (m * n) * (1.0 + others * ((1.0 - a) / (2.0 - a) + a / (1.0 + a)));
    return (a - area) * (a - area) <= z * z * variance;
  };
  // The set of areas is an interval around `area`. Bisect until the end no longer moves.
  const auto end = [&](double outside) {
    if (outside == area)
      return outside;
    double in = area;
    double out = outside;
    for (double middle = 0.5 * (in + out); middle != in && middle != out; middle = 0.5 * (in + out))
      (inside(middle) ? in : out) = middle;
    return in;
  };
  return {end(0.0), end(1.0)};
}

void ThresholdBootstrapOptions::validate() const {
  if (replications < 100)
    throw InputError("bootstrap replications", fmt::format("{}", replications), "100 or more");
  two_sided_normal_quantile(confidence);  // refuses a level outside of 0 to 1
}

Interval best_threshold_interval(Scores positive_scores, Scores negative_scores, RandomStream& stream,
                                 const ThresholdBootstrapOptions& options) {
  options.validate();
  const std::vector<double> positives = without_nan(positive_scores);
  const std::vector<double> negatives = without_nan(negative_scores);
  if (positives.empty() || negatives.empty())
    return {kNaN, kNaN};
  std::vector<double> thresholds;
  for (int i = 0; i < options.replications; ++i) {
    const SortedScores positive = resample(positives, stream), negative = resample(negatives, stream);
    if (const double threshold = roc_curve({positive}, {negative}).best.threshold; std::isfinite(threshold))
      thresholds.push_back(threshold);
  }
  if (2 * thresholds.size() < static_cast<std::size_t>(options.replications))
    return {kNaN, kNaN};
  std::sort(thresholds.begin(), thresholds.end());
  return {sorted_quantile(thresholds, 0.5 - 0.5 * options.confidence),
          sorted_quantile(thresholds, 0.5 + 0.5 * options.confidence)};
}

}  // namespace mpm
