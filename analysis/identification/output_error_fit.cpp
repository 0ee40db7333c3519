#include "analysis/identification/output_error_fit.hpp"

#include <algorithm>
#include <utility>

#include "analysis/identification/identification.hpp"
#include "analysis/identification/output_error_search.hpp"
#include "analysis/identification/output_error_start.hpp"
#include "analysis/identification/prediction_error_options.hpp"
#include "analysis/identification/prediction_error_search.hpp"

namespace mpm {
namespace {

/// Converts the coefficients of a model of scaled signals into a model of the signals themselves.
PolynomialModel polynomial_model(const OutputErrorCoefficients& found, Eigen::Index delay, double y_unit,
                                 const Eigen::VectorXd& u_unit) {
  PolynomialModel model;
  for (Eigen::Index j = 0; j < found.B.cols(); ++j)
    model.inputs.push_back({found.B.col(j) * (y_unit / u_unit(j)), found.F.col(j), delay});
  return model;
}

/// nb of a proper B/F of this order.
Eigen::Index coefficients_of(Eigen::Index order, Eigen::Index delay) {
  return delay == 0 ? order + 1 : order;
}

}  // namespace

OutputErrorFits::OutputErrorFits(const Eigen::Ref<const Eigen::MatrixXd>& u, int max_iterations)
    : u_(u), unit_(u.rows()), max_iterations_(max_iterations) {
  for (Eigen::Index j = 0; j < u.rows(); ++j)
    unit_(j) = unit_of(u.row(j).transpose());
}

std::vector<OutputErrorFit> OutputErrorFits::fit(const Eigen::Ref<const Eigen::VectorXd>& y,
                                                 const std::vector<Eigen::Index>& orders,
                                                 Eigen::Index delay) const {
  const double largest_radius = PredictionErrorOptions{}.largest_radius;
  const Eigen::Index nu = u_.rows(), N = u_.cols();
  Eigen::Index rows = 0;
  for (const Eigen::Index order : orders) {
    const Eigen::Index nb = coefficients_of(order, delay);
    require_identification_data(y, u_, output_error_order(nu, nb, order, delay), 0);
    rows = std::max({rows, order + 1, nb + delay});
  }
  const Eigen::MatrixXd scaled_u = unit_.cwiseInverse().asDiagonal() * u_;
  const double unit = unit_of(y);
  const Eigen::VectorXd scaled_y = y / unit;
  OutputErrors errors(scaled_u, scaled_y, delay, rows);
  // The search refuses roots outside the largest radius, so rounding must not put a start at the border
  // outside.
  OutputErrorStarts starts(scaled_u, scaled_y, delay, rows, 1.0 - 2.0 * (1.0 - largest_radius), errors);
  std::vector<OutputErrorFit> fits;
  for (const Eigen::Index order : orders) {
    const OutputErrorMinimum found = search_output_error(
        errors, starts.best(coefficients_of(order, delay), order), {max_iterations_, largest_radius});
    OutputErrorFit fit{polynomial_model(found.model, delay, unit, unit_),
                       unit * unit * found.loss / static_cast<double>(N)};
    fit.model.noise_variance = fit.loss;
    fits.push_back(std::move(fit));
  }
  return fits;
}

}  // namespace mpm
