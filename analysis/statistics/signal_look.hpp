#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace mpm {

/// Properties of a recorded signal that follow from its sequence of values, without a model.
struct SignalLook {
  std::vector<double> values;
  double mean = 0.0, deviation = 0.0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  double changes = 0.0;  ///< share of the values that differ from the previous one

  explicit SignalLook(std::vector<double> of);

  /// Returns the places of the new values: the first value, and each that differs from the previous one.
  std::vector<std::size_t> fresh() const;
  /// Returns the standard deviation of the white noise in the signal, from the second differences b,
  ///
  ///   1.4826 median |b| / sqrt(6),    b(k) = x(k) - 2 x(k - 1) + x(k - 2),
  ///
  /// in which a slowly moving signal leaves almost nothing. If the signal is held for most of the time, like
  /// that of an analyser, only its new values are used. 0 for fewer than three values.
  double noise() const;
  /// Returns the number of values from one new value to the next, if it is nearly always the same and more
  /// than one.
  std::optional<std::size_t> period() const;
  /// Returns the most frequent number of values from one new value to the next; none for fewer than 11 new
  /// values. A signal that is only rounded repeats values by chance, and the number is 1.
  std::optional<std::size_t> usual_gap() const;
  /// Returns the share of the values that lie in the upper or lower tenth of the range.
  double share_at(bool upper) const;

 private:
  /// Counts how often each number of values from one new value to the next occurs; empty for fewer than 11
  /// new values.
  std::map<std::size_t, std::size_t> gaps() const;
};

}  // namespace mpm
