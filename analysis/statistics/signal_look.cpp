#include "analysis/statistics/signal_look.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/statistics/quantile.hpp"

namespace mpm {

SignalLook::SignalLook(std::vector<double> of) : values(std::move(of)) {
  const auto count = static_cast<double>(values.size());
  for (const double value : values) {
    mean += value / count;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  for (std::size_t row = 0; row < values.size(); ++row) {
    deviation += (values[row] - mean) * (values[row] - mean) / count;
    changes += row > 0 && values[row] != values[row - 1] ? 1.0 / count : 0.0;
  }
  deviation = std::sqrt(deviation);
}

std::vector<std::size_t> SignalLook::fresh() const {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (row == 0 || values[row] != values[row - 1])
      rows.push_back(row);
  return rows;
}

double SignalLook::noise() const {
  constexpr double kOfNormal = 1.4826;  // standard deviation / median absolute deviation, if normal
  constexpr double kHeld = 0.7;         // share of new values: noise that is not held is nearly always new
  std::vector<double> seen = values, bends;
  if (changes < kHeld) {
    seen.clear();
    for (const std::size_t row : fresh())
      seen.push_back(values[row]);
  }
  for (std::size_t i = 2; i < seen.size(); ++i)
    bends.push_back(std::abs(seen[i] - 2.0 * seen[i - 1] + seen[i - 2]));
  return bends.empty() ? 0.0 : kOfNormal * upper_median(std::move(bends)) / std::sqrt(6.0);
}

std::map<std::size_t, std::size_t> SignalLook::gaps() const {
  constexpr std::size_t kFewest = 10;  // new values
  const std::vector<std::size_t> rows = fresh();
  std::map<std::size_t, std::size_t> counts;
  for (std::size_t i = 1; i < rows.size() && rows.size() > kFewest; ++i)
    ++counts[rows[i] - rows[i - 1]];
  return counts;
}

std::optional<std::size_t> SignalLook::usual_gap() const {
  const std::map<std::size_t, std::size_t> counts = gaps();
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? std::nullopt : std::optional(most->first);
}

std::optional<std::size_t> SignalLook::period() const {
  constexpr double kNearlyAlways = 0.9;
  const std::map<std::size_t, std::size_t> counts = gaps();
  std::size_t all = 0;
  for (const auto& each : counts)
    all += each.second;
  const std::optional<std::size_t> gap = usual_gap();
  return gap && *gap > 1 && static_cast<double>(counts.at(*gap)) >= kNearlyAlways * static_cast<double>(all)
             ? gap
             : std::nullopt;
}

double SignalLook::share_at(bool upper) const {
  constexpr double kEnd = 0.1;
  const double width = kEnd * (highest - lowest);
  const auto inside = std::count_if(values.begin(), values.end(), [&](double value) {
    return upper ? value >= highest - width : value <= lowest + width;
  });
  return static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

}  // namespace mpm
