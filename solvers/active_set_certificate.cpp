#include "solvers/active_set_certificate.hpp"

#include <cmath>

#include "base/non_finite.hpp"

namespace mpm {
namespace {

constexpr double kRounding = 1e-12;

}  // namespace

double proven_violation(const QpStructure& structure, const QpData& data, const Eigen::VectorXd& y,
                        Eigen::VectorXd& scratch) {
  const double nothing = -kInfinity;
  const double total = y.lpNorm<1>();
  if (!(total > 0.0) || !std::isfinite(total))
    return nothing;
  double gap = 0.0;
  for (Eigen::Index i = 0; i < y.size(); ++i)
    if (y(i) != 0.0)
      gap -= y(i) * (y(i) > 0.0 ? data.hard_upper(i) : data.hard_lower(i));

  scratch.noalias() = structure.rows.transpose() * y;
  for (Eigen::Index j = 0; j < scratch.size(); ++j) {
    const double limit = scratch(j) > 0.0 ? data.lower(j) : data.upper(j);
    if (scratch(j) != 0.0 && std::isfinite(limit))
      gap += scratch(j) * limit;
    else if (std::abs(scratch(j)) > kRounding * structure.rows.col(j).cwiseAbs().dot(y.cwiseAbs()))
      return nothing;
  }
  return std::isfinite(gap) ? gap / total : nothing;
}

}  // namespace mpm
