#include "analysis/identification/percent_fit.hpp"

#include <cmath>
#include <limits>

#include "analysis/statistics/signal_check.hpp"

namespace mpm {

double percent_fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                   const Eigen::Ref<const Eigen::VectorXd>& y_est) {
  require_signal("output", y, 2);
  require_same_length("output", y, "its estimate", y_est);
  if (!y_est.allFinite())
    return -std::numeric_limits<double>::infinity();
  const double spread = (y.array() - y.mean()).matrix().squaredNorm();
  if (spread <= static_cast<double>(y.size()) * variance_floor(y))
    return std::numeric_limits<double>::quiet_NaN();
  return 100.0 * (1.0 - std::sqrt((y - y_est).squaredNorm() / spread));
}

}  // namespace mpm
