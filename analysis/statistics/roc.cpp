#include "analysis/statistics/roc.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "analysis/statistics/quantile.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

using Scores = std::span<const double>;

struct Case {
  double score;
  bool positive;
};

void append(std::vector<Case>& cases, Scores scores, bool positive) {
  for (const double score : scores)
    if (!std::isnan(score))
      cases.push_back({score, positive});
}

/// Halfway between two scores: also when their sum would overflow, and never equal to the upper one.
double between(double upper, double lower) {
  if (std::isinf(lower) || std::isinf(upper))
    return lower;
  const double middle = lower + 0.5 * (upper - lower);
  return middle < upper ? middle : lower;
}

double share(std::int64_t hits, std::int64_t total) {
  return total > 0 ? static_cast<double>(hits) / static_cast<double>(total) : kNaN;
}

/// How many cases of each side are above some threshold.
struct Above {
  std::int64_t positives = 0, negatives = 0;
};

RocPoint point(double threshold, const Above& above, std::int64_t positives, std::int64_t negatives) {
  return {threshold, share(above.positives, positives), share(above.negatives, negatives),
          share(above.positives, above.positives + above.negatives)};
}

/// The curve of cases in descending order of their scores.
RocCurve curve_of_sorted(const std::vector<Case>& cases) {
  RocCurve curve;
  curve.positives = std::count_if(cases.begin(), cases.end(), [](const Case& c) { return c.positive; });
  curve.negatives = static_cast<std::int64_t>(cases.size()) - curve.positives;
  if (!curve.defined())
    return curve;
  Above above;
  curve.points.push_back(point(kInfinity, above, curve.positives, curve.negatives));
  curve.area = curve.average_precision = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    ++(cases[i].positive ? above.positives : above.negatives);
    const bool last = i + 1 == cases.size();
    if (!last && cases[i + 1].score == cases[i].score)
      continue;  // equal scores fall together
    const double threshold = last ? -kInfinity : between(cases[i].score, cases[i + 1].score);
    const RocPoint before = curve.points.back();
    curve.points.push_back(point(threshold, above, curve.positives, curve.negatives));
    const RocPoint& now = curve.points.back();
    curve.area += (now.false_positive_rate - before.false_positive_rate) * 0.5 *
                  (now.true_positive_rate + before.true_positive_rate);
    curve.average_precision += (now.true_positive_rate - before.true_positive_rate) * now.precision;
    if (now.youden() > curve.points[curve.best].youden())
      curve.best = curve.points.size() - 1;
  }
  return curve;
}

void sort_descending(std::vector<Case>& cases) {
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.score > b.score; });
}

std::vector<double> without_nan(Scores scores) {
  std::vector<double> kept;
  std::copy_if(scores.begin(), scores.end(), std::back_inserter(kept),
               [](double score) { return !std::isnan(score); });
  return kept;
}

void append_resample(std::vector<Case>& cases, const std::vector<double>& scores, bool positive,
                     RandomStream& stream) {
  for (std::size_t i = 0; i < scores.size(); ++i)
    cases.push_back({scores[stream.below(scores.size())], positive});
}

}  // namespace

RocCurve roc_curve(Scores positive_scores, Scores negative_scores) {
  std::vector<Case> cases;
  append(cases, positive_scores, true);
  append(cases, negative_scores, false);
  sort_descending(cases);
  RocCurve curve = curve_of_sorted(cases);
  curve.left_out = static_cast<std::int64_t>(positive_scores.size() + negative_scores.size() - cases.size());
  return curve;
}

RocPoint roc_point(Scores positive_scores, Scores negative_scores, double threshold) {
  std::vector<Case> cases;
  append(cases, positive_scores, true);
  append(cases, negative_scores, false);
  Above all, above;
  for (const Case& c : cases) {
    ++(c.positive ? all.positives : all.negatives);
    if (c.score > threshold)
      ++(c.positive ? above.positives : above.negatives);
  }
  return point(threshold, above, all.positives, all.negatives);
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
  // The set is an interval around `area`: halve until neither end moves.
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
  std::vector<Case> cases;
  for (int i = 0; i < options.replications; ++i) {
    cases.clear();
    append_resample(cases, positives, true, stream);
    append_resample(cases, negatives, false, stream);
    sort_descending(cases);
    const RocCurve curve = curve_of_sorted(cases);
    if (const double threshold = curve.points[curve.best].threshold; std::isfinite(threshold))
      thresholds.push_back(threshold);
  }
  if (2 * thresholds.size() < static_cast<std::size_t>(options.replications))
    return {kNaN, kNaN};
  std::sort(thresholds.begin(), thresholds.end());
  return {sorted_quantile(thresholds, 0.5 - 0.5 * options.confidence),
          sorted_quantile(thresholds, 0.5 + 0.5 * options.confidence)};
}

}  // namespace mpm
