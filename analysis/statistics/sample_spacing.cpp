#include "analysis/statistics/sample_spacing.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

Eigen::Index sample_spacing(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  Eigen::Index spacing = signal.size(), last = -1;
  for (Eigen::Index k = 0; k < signal.size() && spacing > 1; ++k) {
    if (std::isnan(signal(k)))
      continue;
    if (last >= 0)
      spacing = std::min(spacing, k - last);
    last = k;
  }
  return spacing;
}

}  // namespace mpm
