#include "analysis/identification/output_error_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/identification/lane_cholesky.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

// The trust region as in Ceres, and the tolerances of search_prediction_error().
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

/// The step from (J'J + diagonal/radius) step = -J'e, and the fall of the cost that the linear model
/// predicts. damped_step() returns none if rounding leaves no such step.
struct Step {
  Eigen::VectorXd step;
  double predicted;
};

std::optional<Step> damped_step(const Eigen::MatrixXd& JJ, const Eigen::VectorXd& Je, double radius,
                                LaneCholesky& factor) {
  Eigen::MatrixXd damped = JJ;
  damped.diagonal() += JJ.diagonal().cwiseMax(kSmallestDiagonal) / radius;
  if (!factor.compute(damped, 0.0))
    return std::nullopt;
  Step result{-factor.solve(Je), 0.0};
  result.predicted = -result.step.dot(Je) - 0.5 * result.step.dot(JJ * result.step);
  if (!(result.predicted > 0.0))
    return std::nullopt;
  return result;
}

}  // namespace

OutputErrorMinimum search_output_error(OutputErrors& errors, const OutputErrorCoefficients& start,
                                       const OutputErrorSearch& search) {
  const auto cost_of = [&](const OutputErrorCoefficients& model) {
    const bool allowed =
        model.B.allFinite() && model.F.allFinite() && roots_within(model.F, search.largest_radius);
    return allowed ? errors.cost(model) : kInfinity;
  };
  OutputErrorCoefficients best = start;
  double cost = cost_of(best);
  if (!std::isfinite(cost))
    return {best, kInfinity};
  Eigen::MatrixXd JJ;
  Eigen::VectorXd Je;
  errors.products(JJ, Je);
  const Eigen::VectorXd scale = (1.0 + JJ.diagonal().cwiseMax(0.0).cwiseSqrt().array()).inverse();
  const auto rescale = [&] {
    JJ = scale.asDiagonal() * JJ * scale.asDiagonal();
    Je = scale.asDiagonal() * Je;
  };
  rescale();
  LaneCholesky factor;
  double radius = kFirstRadius, shrink = 2.0;
  int invalid = 0;
  for (int iteration = 0; iteration < search.max_iterations && radius > kSmallestRadius; ++iteration) {
    const std::optional<Step> step = damped_step(JJ, Je, radius, factor);
    if (!step && ++invalid > kInvalidSteps)
      break;
    double quality = 0.0;
    if (step) {
      invalid = 0;
      const Eigen::VectorXd change = scale.asDiagonal() * step->step;
      if (change.norm() <= kStepTolerance * (free_coefficients(best).norm() + kStepTolerance))
        break;
      const OutputErrorCoefficients next = moved(best, change);
      const double next_cost = cost_of(next);
      if (std::abs(cost - next_cost) <= kFunctionTolerance * cost)
        break;
      quality = (cost - next_cost) / step->predicted;
      if (quality > kLeastQuality) {
        best = next;
        cost = next_cost;
        errors.products(JJ, Je);
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
  return {best, 2.0 * cost};
}

}  // namespace mpm
