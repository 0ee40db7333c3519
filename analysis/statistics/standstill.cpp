#include "analysis/statistics/standstill.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

Standstill longest_standstill(const Eigen::Ref<const Eigen::RowVectorXd>& values) {
  Standstill longest;
  Eigen::Index most = 0, present = 0, equal = 0;  // values of the longest stretch, values, equal neighbours
  Eigen::Index first = 0, run = 0, last = -1;     // the stretch at hand, and the last value
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (std::isnan(values(k)))
      continue;
    const bool goes_on = last >= 0 && values(k) == values(last);
    equal += goes_on ? 1 : 0;
    first = goes_on ? first : k;
    run = goes_on ? run + 1 : 1;
    last = k;
    ++present;
    if (run > most) {
      most = run;
      longest.first = first;
      longest.end = k + 1;
    }
  }
  if (most == 0)
    return longest;
  // A stretch has one neighbour fewer than values; those at its two ends differ.
  const auto equal_outside = static_cast<double>(equal - (most - 1));
  const auto neighbours_outside = static_cast<double>(std::max<Eigen::Index>(0, present - most));
  const double p = (equal_outside + 1.0) / (neighbours_outside + 2.0);
  longest.chance =
      std::min(1.0, static_cast<double>(values.size()) * std::pow(p, static_cast<double>(most - 1)));
  return longest;
}

bool is_long(const Standstill& stretch, Eigen::Index samples) {
  constexpr Eigen::Index kFewestSamples = 20;
  constexpr double kLeastShare = 0.1;
  return stretch.length() > kFewestSamples &&
         static_cast<double>(stretch.length()) > kLeastShare * static_cast<double>(samples);
}

}  // namespace mpm
