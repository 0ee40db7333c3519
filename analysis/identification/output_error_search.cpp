#include "analysis/identification/output_error_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>

#include "analysis/statistics/discrete_filter.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

// As in Ceres: the trust region, and the tolerances of search_prediction_error.
constexpr double kFirstRadius = 1e4;
constexpr double kLargestRadius = 1e16;
constexpr double kSmallestRadius = 1e-32;
constexpr double kSmallestDiagonal = 1e-6;
constexpr double kLeastQuality = 1e-3;
constexpr int kInvalidSteps = 50;
constexpr double kFunctionTolerance = 1e-14;
constexpr double kStepTolerance = 1e-11;

Eigen::VectorXd free_coefficients(const OutputErrorCoefficients& model) {
  const Eigen::Index nb = model.B.rows(), nf = model.F.rows() - 1;
  Eigen::MatrixXd all(nb + nf, model.B.cols());
  all << model.B, model.F.bottomRows(nf);
  return all.reshaped();
}

OutputErrorCoefficients moved(const OutputErrorCoefficients& model, const Eigen::VectorXd& step) {
  const Eigen::Index nb = model.B.rows(), nf = model.F.rows() - 1;
  const auto steps = step.reshaped(nb + nf, model.B.cols());
  OutputErrorCoefficients result = model;
  result.B += steps.topRows(nb);
  result.F.bottomRows(nf) += steps.bottomRows(nf);
  return result;
}

/// The errors of a model, their gradient, and the products of both.
class OutputErrors {
 public:
  OutputErrors(const OutputErrorProblem& problem, const OutputErrorCoefficients& model)
      : problem_(problem),
        order_(model.F.rows() - 1),
        memory_(model.B.rows() + order_ + problem.delay),
        filtered_(problem.u.count(), problem.u.samples(), memory_),
        path_(problem.u.count(), problem.u.samples(), memory_),
        filtered_path_(problem.u.count(), problem.u.samples(), memory_),
        shifted_(2 * problem.u.count() + 1, problem.u.samples(), memory_),
        one_(Eigen::MatrixXd::Ones(1, problem.u.count())) {
    const Eigen::Index nu = problem.u.count(), nb = model.B.rows();
    sign_.resize(nu * (nb + order_));
    for (Eigen::Index j = 0; j < nu; ++j) {
      columns_.push_back({j, problem.delay, nb});
      columns_.push_back({nu + j, 1, order_});
      sign_.segment(j * (nb + order_), nb).setConstant(-1.0);
      sign_.segment(j * (nb + order_) + nb, order_).setOnes();
    }
  }

  /// Half the sum of e^2, and `errors` of this model from here on; infinity for one that is refused.
  double cost(const OutputErrorCoefficients& model) {
    if (!model.B.allFinite() || !model.F.allFinite() || !roots_within(model.F, problem_.largest_radius))
      return kInfinity;
    filter_bank(one_, model.F, 0, problem_.u, filtered_);
    filter_bank(model.B, one_, problem_.delay, filtered_, path_);
    errors_ = problem_.y;
    for (Eigen::Index j = 0; j < path_.count(); ++j)
      errors_ -= path_[j];
    const double sum = errors_.squaredNorm();
    return std::isfinite(sum) ? 0.5 * sum : kInfinity;
  }

  /// J'J and J'e at the model of the last `cost`.
  void products(const OutputErrorCoefficients& model, Eigen::MatrixXd& JJ, Eigen::VectorXd& Je) {
    filter_bank(one_, model.F, 0, path_, filtered_path_);
    const Eigen::Index nu = filtered_.count();
    for (Eigen::Index j = 0; j < nu; ++j) {
      shifted_[j] = filtered_[j];
      shifted_[nu + j] = filtered_path_[j];
    }
    shifted_[2 * nu] = errors_;
    JJ = sign_.asDiagonal() * lagged_products(shifted_, columns_, 0) * sign_.asDiagonal();
    Je = sign_.asDiagonal() * lagged_products_with(shifted_, columns_, 2 * nu, 0);
  }

 private:
  const OutputErrorProblem& problem_;
  Eigen::Index order_, memory_;
  SignalBank filtered_, path_, filtered_path_;  // u/F, B u/F, B u/F^2
  ShiftedSignals shifted_;                      // u/F, B u/F^2 and e
  Eigen::MatrixXd one_;
  Eigen::VectorXd errors_, sign_;
  std::vector<LaggedColumns> columns_;
};

/// The step from (J'J + diagonal/radius) step = -J'e, and by how much the linear model falls; none where
/// rounding leaves no such step.
struct Step {
  Eigen::VectorXd step;
  double predicted;
};

std::optional<Step> damped_step(const Eigen::MatrixXd& JJ, const Eigen::VectorXd& Je, double radius) {
  Eigen::MatrixXd damped = JJ;
  damped.diagonal() += JJ.diagonal().cwiseMax(kSmallestDiagonal) / radius;
  const Eigen::LLT<Eigen::MatrixXd> factor(damped);
  if (factor.info() != Eigen::Success)
    return std::nullopt;
  Step result{-factor.solve(Je), 0.0};
  result.predicted = -result.step.dot(Je) - 0.5 * result.step.dot(JJ * result.step);
  if (!(result.predicted > 0.0))
    return std::nullopt;
  return result;
}

}  // namespace

bool roots_within(const Eigen::MatrixXd& F, double radius) {
  for (Eigen::Index j = 0; j < F.cols(); ++j)
    if (!has_roots_within(F.col(j), radius))
      return false;
  return true;
}

double output_error_loss(const OutputErrorProblem& problem, const OutputErrorCoefficients& model) {
  return 2.0 * OutputErrors(problem, model).cost(model);
}

OutputErrorCoefficients search_output_error(const OutputErrorProblem& problem,
                                            const OutputErrorCoefficients& start) {
  OutputErrors errors(problem, start);
  OutputErrorCoefficients best = start;
  double cost = errors.cost(best);
  if (!std::isfinite(cost))
    return best;
  Eigen::MatrixXd JJ;
  Eigen::VectorXd Je;
  errors.products(best, JJ, Je);
  const Eigen::VectorXd scale = (1.0 + JJ.diagonal().cwiseMax(0.0).cwiseSqrt().array()).inverse();
  const auto rescale = [&] {
    JJ = scale.asDiagonal() * JJ * scale.asDiagonal();
    Je = scale.asDiagonal() * Je;
  };
  rescale();
  double radius = kFirstRadius, shrink = 2.0;
  int invalid = 0;
  for (int iteration = 0; iteration < problem.max_iterations && radius > kSmallestRadius; ++iteration) {
    const std::optional<Step> step = damped_step(JJ, Je, radius);
    if (!step && ++invalid > kInvalidSteps)
      break;
    double quality = 0.0;
    if (step) {
      invalid = 0;
      const Eigen::VectorXd change = scale.asDiagonal() * step->step;
      if (change.norm() <= kStepTolerance * (free_coefficients(best).norm() + kStepTolerance))
        break;
      const OutputErrorCoefficients next = moved(best, change);
      const double next_cost = errors.cost(next);
      if (std::abs(cost - next_cost) <= kFunctionTolerance * cost)
        break;
      quality = (cost - next_cost) / step->predicted;
      if (quality > kLeastQuality) {
        best = next;
        cost = next_cost;
        errors.products(best, JJ, Je);
        rescale();
      }
    }
    if (quality > kLeastQuality) {
      radius = std::min(kLargestRadius, radius / std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3)));
      shrink = 2.0;
    } else {
      radius /= shrink;
      shrink *= 2.0;
    }
  }
  return best;
}

}  // namespace mpm
