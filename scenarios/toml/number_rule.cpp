#include "scenarios/toml/number_rule.hpp"

#include <cmath>

#include <fmt/format.h>

namespace mpm {

bool NumberRule::contains(double value) const {
  const bool above = low_included ? value >= low : value > low;
  const bool below = high_included ? value <= high : value < high;
  return above && below;
}

bool NumberRule::contains_support(double minimum, double maximum) const {
  const bool unbounded_below = std::isinf(low) && minimum == low;
  const bool unbounded_above = std::isinf(high) && maximum == high;
  return (unbounded_below || contains(minimum)) && (unbounded_above || contains(maximum));
}

std::string NumberRule::text() const {
  if (std::isinf(low) && std::isinf(high)) {
    return "a finite number";
  }
  if (std::isinf(high)) {
    return fmt::format("a number {} {}", low_included ? ">=" : ">", low);
  }
  return fmt::format("a number in {}{}, {}{}", low_included ? '[' : '(', low, high,
                     high_included ? ']' : ')');
}

}  // namespace mpm
