#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace mpm {

/// What the numbers of a recorded signal, one after the other, tell of it without a model.
struct SignalLook {
  std::vector<double> values;
  double mean = 0.0, deviation = 0.0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  double changes = 0.0;  ///< share of the values that differ from the one before

  explicit SignalLook(std::vector<double> of);

  /// The places at which the value is another one than before.
  std::vector<std::size_t> fresh() const;
  /// The standard deviation of white noise in it, from the second differences b,
  ///
  ///   1.4826 median |b| / sqrt(6),    b(k) = x(k) - 2 x(k - 1) + x(k - 2),
  ///
  /// in which a signal that moves slowly leaves next to nothing. Of a signal that is held for most of the
  /// time, such as that of an analyser, of the values that are new. 0 for fewer than three values.
  double noise() const;
  /// The number of values from one new value to the next, where it is nearly always the same and more than
  /// one.
  std::optional<std::size_t> period() const;
  /// The most frequent number of values from one new value to the next; none for fewer than 11 new values.
  /// What is only rounded repeats itself by chance, and has 1.
  std::optional<std::size_t> usual_gap() const;
  /// The share of the values in the tenth of the range at one end.
  double share_at(bool upper) const;

 private:
  /// How often each number of values from one new value to the next is there; empty for fewer than 11 new
  /// values.
  std::map<std::size_t, std::size_t> gaps() const;
};

}  // namespace mpm
