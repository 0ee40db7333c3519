#include "analysis/identification/identification_check.hpp"

#include <fmt/format.h>

#include "analysis/statistics/signal_check.hpp"
#include "plants/error.hpp"

namespace mpm {

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

}  // namespace mpm
