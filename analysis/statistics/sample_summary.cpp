#include "analysis/statistics/sample_summary.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/student.hpp"

namespace mpm {

SampleSummary summarise(const std::vector<double>& values, double confidence) {
  SampleSummary summary;
  double sum = 0.0;
  for (const double value : values) {
    if (std::isnan(value))
      continue;
    summary.least = summary.count == 0 ? value : std::min(summary.least, value);
    summary.largest = summary.count == 0 ? value : std::max(summary.largest, value);
    sum += value;
    ++summary.count;
  }
  if (summary.count == 0)
    return summary;
  const auto n = static_cast<double>(summary.count);
  summary.mean = sum / n;
  if (summary.count < 2)
    return summary;
  double squares = 0.0;
  for (const double value : values)
    if (!std::isnan(value))
      squares += (value - summary.mean) * (value - summary.mean);
  const double half = student_quantile(0.5 + 0.5 * confidence, n - 1.0) * std::sqrt(squares / (n - 1.0) / n);
  summary.mean_interval = {summary.mean - half, summary.mean + half};
  return summary;
}

}  // namespace mpm
