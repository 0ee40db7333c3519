#include "results/records/implausible_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace mpm {
namespace {

constexpr double kTail = 0.05;  // share of the values on either side of the core
constexpr double kGapOfFillers = 10.0;
constexpr double kGapOfSpikes = 1000.0;
constexpr std::size_t kLongestSpike = 5;
constexpr double kLeastHuge = 1e20;

/// Tells whether programs write this value for a missing one.
bool is_filler(double value) {
  static constexpr std::array kOthers{999.25, 32767.0, 32768.0, 65535.0, 2147483647.0, 2147483648.0};
  const double size = std::abs(value);
  if (size >= kLeastHuge || std::find(kOthers.begin(), kOthers.end(), size) != kOthers.end())
    return true;
  double nines = 999.0;
  while (nines < size)
    nines = 10.0 * nines + 9.0;
  return size == nines;
}

/// Tells whether people would choose this number for a missing value: 100 and above, of one or two digits.
bool is_round(double value) {
  constexpr double kLeastRound = 100.0;
  double digits = std::abs(value);
  if (!(digits >= kLeastRound))
    return false;
  while (digits >= kLeastRound && std::fmod(digits, 10.0) == 0.0)
    digits /= 10.0;
  return digits < kLeastRound && digits == std::floor(digits);
}

/// The values that may stand for a missing one: those that programs write and, if the signal is measured,
/// round values that recur.
class Fillers {
 public:
  Fillers(const std::vector<double>& values, bool measured) {
    std::vector<double> sorted;
    if (measured)
      std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
                   [](double value) { return !std::isnan(value) && !is_filler(value); });
    std::sort(sorted.begin(), sorted.end());
    std::ptrdiff_t others = 0, kinds = 0, most = 0, again = 0;
    for (auto first = sorted.begin(); first != sorted.end();) {
      const auto end = std::find_if(first, sorted.end(), [&](double value) { return value != *first; });
      const std::ptrdiff_t count = end - first;
      if (count > 1 && is_round(*first)) {
        rounds_.push_back(*first);
        again += count;
      } else {
        others += count;
        most = std::max(most, count);
        ++kinds;
      }
      first = end;
    }
    constexpr std::ptrdiff_t kFewestKinds = 10;  // fewer are levels, and no measurements
    if (kinds < kFewestKinds || again > others || 2 * most > others)
      rounds_.clear();
  }

  bool has(double value) const {
    return is_filler(value) || std::binary_search(rounds_.begin(), rounds_.end(), value);
  }

 private:
  std::vector<double> rounds_;  ///< ascending
};

struct Core {
  double lower, upper;

  double width() const { return upper - lower; }
  /// Distance from the core to the value; 0 within the core.
  double gap(double value) const { return std::max({lower - value, value - upper, 0.0}); }
};

/// Returns the core, which grows from the middle outwards as long as the next value follows without a large
/// gap.
Core core_of(std::vector<double> sorted, double lower, double upper) {
  std::sort(sorted.begin(), sorted.end());
  const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(sorted.size()));
  std::size_t first = tail, last = sorted.size() - 1 - tail;
  const bool limited = std::isfinite(lower) && std::isfinite(upper);
  const auto core = [&] {
    return limited ? Core{std::min(sorted[first], lower), std::max(sorted[last], upper)}
                   : Core{sorted[first], sorted[last]};
  };
  const auto follows = [&](std::size_t next) {
    return core().gap(sorted[next]) <= kGapOfSpikes * core().width();
  };
  for (bool grown = true; grown;) {
    grown = false;
    for (; first > 0 && follows(first - 1); grown = true)
      --first;
    for (; last + 1 < sorted.size() && follows(last + 1); grown = true)
      ++last;
  }
  return core();
}

}  // namespace

std::vector<std::size_t> implausible_rows(const std::vector<double>& values, double lower, double upper,
                                          bool measured) {
  const Fillers fillers(values, measured);
  std::vector<double> sure;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sure),
               [&](double value) { return !std::isnan(value) && !fillers.has(value); });
  if (sure.empty())
    return {};
  const Core core = core_of(std::move(sure), lower, upper);
  const bool has_width = core.width() > 0.0;
  std::vector<std::size_t> rows, spike;
  bool inside = false;  // the last value that is no filler was in the core
  for (std::size_t row = 0; row < values.size(); ++row) {
    const double value = values[row];
    if (std::isnan(value))
      continue;
    if (fillers.has(value)) {
      if (core.gap(value) > kGapOfFillers * core.width())
        rows.push_back(row);
    } else if (has_width && core.gap(value) > kGapOfSpikes * core.width()) {
      spike.push_back(row);
    } else {
      if (inside && spike.size() <= kLongestSpike)
        rows.insert(rows.end(), spike.begin(), spike.end());
      spike.clear();
      inside = true;
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace mpm
