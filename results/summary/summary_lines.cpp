#include "results/summary/summary_lines.hpp"

#include <cmath>

namespace mpm {

void SummaryLines::entry(const std::string& name, const std::string& value) {
  constexpr std::size_t kValueWidth = 86;
  std::string left = value;
  std::string label = name;
  while (left.size() > kValueWidth) {
    const std::size_t blank = left.rfind(' ', kValueWidth);
    if (blank == std::string::npos || blank == 0)
      break;
    line("{:<12}  {}", label, left.substr(0, blank));
    left.erase(0, blank + 1);
    label.clear();
  }
  line("{:<12}  {}", label, left);
}

std::string number_text(double value, bool share) {
  if (std::isnan(value))
    return "-";
  return share ? fmt::format("{:.1f} %", 100.0 * value) : fmt::format("{:.3f}", value);
}

std::string interval_text(const Interval& interval, bool share) {
  if (std::isnan(interval.lower) || std::isnan(interval.upper))
    return "-";
  return share ? fmt::format("{:.1f} to {:.1f} %", 100.0 * interval.lower, 100.0 * interval.upper)
               : fmt::format("{:.3f} to {:.3f}", interval.lower, interval.upper);
}

std::string digits_text(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

std::string plural(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

}  // namespace mpm
