#pragma once

#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/interval.hpp"

namespace mpm {

/// The lines of a text for people, one after the other.
class SummaryLines {
 public:
  /// A line in the form of fmt, without the blanks at its end: tables pad their last column.
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_.erase(text_.find_last_not_of(' ') + 1);
    text_ += '\n';
  }
  /// An entry of the heading; a long value goes on in lines of its own.
  void entry(const std::string& name, const std::string& value);
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Width of the names in tables of measured numbers.
inline constexpr std::size_t kNameWidth = 36;

/// A number of a table with three decimals: a percentage for a share, "-" when there is none.
std::string number_text(double value, bool share);

/// "0.100 to 0.250", of a share "10.0 to 25.0 %"; "-" when there is none.
std::string interval_text(const Interval& interval, bool share);

/// A number of a table with three digits; "-" when there is none.
std::string digits_text(double value);

/// `count` things: "1 job", "2 jobs".
std::string plural(std::size_t count, const std::string& thing);

}  // namespace mpm
