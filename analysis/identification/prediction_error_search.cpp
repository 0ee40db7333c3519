#include "analysis/identification/prediction_error_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <ceres/ceres.h>

#include "analysis/identification/prediction_error.hpp"
#include "base/row_major.hpp"

namespace mpm {
namespace {

/// Output and inputs in units of their own, so that the tolerances of the search are relative ones.
struct Units {
  double y;
  Eigen::VectorXd u;  // nu

  Units(const Eigen::Ref<const Eigen::VectorXd>& output, const Eigen::Ref<const Eigen::MatrixXd>& inputs)
      : y(unit_of(output)), u(inputs.rows()) {
    for (Eigen::Index j = 0; j < u.size(); ++j)
      u(j) = unit_of(inputs.row(j).transpose());
  }

  /// The same model for signals divided by these units, or back with `direction` -1.
  PolynomialModel scaled(PolynomialModel model, int direction) const {
    for (std::size_t j = 0; j < model.inputs.size(); ++j)
      model.inputs[j].B *= std::pow(u(static_cast<Eigen::Index>(j)) / y, direction);
    return model;
  }
};

/// The prediction errors as a function of the coefficients.
class PredictionErrorCost final : public ceres::CostFunction {
 public:
  PredictionErrorCost(const ModelOrder& order, const Eigen::Ref<const Eigen::VectorXd>& y,
                      const Eigen::Ref<const Eigen::MatrixXd>& u, const PredictionErrorOptions& options)
      : order_(order), y_(y), u_(u), options_(options), n_(y.size() - options.first_sample) {
    set_num_residuals(static_cast<int>(n_));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(order.parameter_count()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index p = order_.parameter_count();
    const Eigen::Map<const Eigen::VectorXd> theta(parameters[0], p);
    if (!theta.allFinite())
      return false;
    const PolynomialModel model = model_from_parameters(order_, theta);
    if (!(search_radius(model) <= options_.largest_radius))
      return false;
    Eigen::Map<Eigen::VectorXd> errors(residuals, n_);
    errors = prediction_errors(model, y_, u_, options_.start).tail(n_);
    if (!errors.allFinite())
      return false;
    if (jacobians != nullptr && jacobians[0] != nullptr)
      Eigen::Map<RowMajorMatrix>(jacobians[0], n_, p) =
          prediction_error_gradient(model, y_, u_, options_.start).bottomRows(n_);
    return true;
  }

 private:
  ModelOrder order_;
  Eigen::VectorXd y_;
  Eigen::MatrixXd u_;
  PredictionErrorOptions options_;
  Eigen::Index n_;
};

ceres::Solver::Options solver_options(const PredictionErrorOptions& options) {
  ceres::Solver::Options solver;
  solver.minimizer_type = ceres::TRUST_REGION;
  solver.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  solver.linear_solver_type = ceres::DENSE_QR;
  // Eigen and one thread: the same bits in every run.
  solver.dense_linear_algebra_library_type = ceres::EIGEN;
  solver.num_threads = 1;
  solver.max_num_iterations = options.max_iterations;
  // Near a border of stability many trial steps may be refused in a row.
  solver.max_num_consecutive_invalid_steps = 50;
  solver.function_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-11;
  solver.gradient_tolerance = 1e-15;
  solver.logging_type = ceres::SILENT;
  return solver;
}

}  // namespace

double unit_of(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  const double rms = std::sqrt(signal.squaredNorm() / static_cast<double>(signal.size()));
  return rms > 0.0 ? std::exp2(std::round(std::log2(rms))) : 1.0;
}

double search_radius(const PolynomialModel& model) {
  double radius = std::max(root_radius(model.C), root_radius(model.D));
  for (const InputPath& path : model.inputs)
    radius = std::max(radius, root_radius(path.F));
  return radius;
}

PolynomialModel search_prediction_error(const PolynomialModel& start,
                                        const Eigen::Ref<const Eigen::VectorXd>& y,
                                        const Eigen::Ref<const Eigen::MatrixXd>& u,
                                        const PredictionErrorOptions& options) {
  const ModelOrder order = start.order();
  const Units units(y, u);
  Eigen::VectorXd theta = units.scaled(start, 1).parameters();
  const Eigen::MatrixXd scaled_u = units.u.cwiseInverse().asDiagonal() * u;
  PredictionErrorCost cost(order, y / units.y, scaled_u, options);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, theta.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  // After a failure Ceres leaves the coefficients as they were at the start.
  return units.scaled(model_from_parameters(order, theta), -1);
}

}  // namespace mpm
