#include "analysis/identification/identification.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {

bool is_usable(IdentificationStatus status) {
  return status == IdentificationStatus::ok || status == IdentificationStatus::noise_free ||
         status == IdentificationStatus::at_stability_limit;
}

void require_identification_data(const Eigen::Ref<const Eigen::VectorXd>& y,
                                 const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                                 Eigen::Index first_sample) {
  order.validate(u.rows());
  if (y.size() != u.cols())
    throw InputError("lengths of output and inputs", fmt::format("{} and {}", y.size(), u.cols()),
                     "equal lengths");
  const Eigen::Index parameters = order.parameter_count();
  if (parameters < 1)
    throw InputError("parameters of a model", "none", "1 or more");
  require_signal("output", y, first_sample + parameters + 1);
  if (!u.allFinite())
    throw InputError("inputs", "a value that is not finite", "finite values only");
}

double percent_fit(const Eigen::Ref<const Eigen::VectorXd>& y, double squared_error) {
  require_signal("output", y, 2);
  if (!std::isfinite(squared_error))
    return -kInfinity;
  const double spread = (y.array() - y.mean()).matrix().squaredNorm();
  if (spread <= static_cast<double>(y.size()) * variance_floor(y))
    return kNaN;
  return 100.0 * (1.0 - std::sqrt(squared_error / spread));
}

double percent_fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                   const Eigen::Ref<const Eigen::VectorXd>& y_est) {
  require_signal("output", y, 2);
  require_same_length("output", y, "its estimate", y_est);
  return percent_fit(y, y_est.allFinite() ? (y - y_est).squaredNorm() : kInfinity);
}

}  // namespace mpm
