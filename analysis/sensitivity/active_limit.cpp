#include "analysis/sensitivity/active_limit.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {
namespace {

double tolerance_of(double limit) {
  return 1e-5 * std::max(1.0, std::abs(limit));
}

}  // namespace

bool at_limit(double value, double limit) {
  return std::isfinite(limit) && std::abs(value - limit) <= tolerance_of(limit);
}

bool at_or_below(double value, double lower) {
  return std::isfinite(lower) && value <= lower + tolerance_of(lower);
}

bool at_or_above(double value, double upper) {
  return std::isfinite(upper) && value >= upper - tolerance_of(upper);
}

}  // namespace mpm
