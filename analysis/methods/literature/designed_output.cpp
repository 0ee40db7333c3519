#include "analysis/methods/literature/designed_output.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/identification/identification.hpp"
#include "analysis/identification/output_error_fit.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

using Signals = Eigen::Ref<const Eigen::MatrixXd>;

double root_mean_square(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  return std::sqrt(signal.squaredNorm() / static_cast<double>(signal.size()));
}

/// The inputs from which all rows of S_d and of Delta G K are identified.
struct Inputs {
  Eigen::MatrixXd moving;           ///< the eps that move, deviations from the start of the record
  std::vector<Eigen::Index> of_cv;  ///< CV of each row of `moving`
  Eigen::Index all;                 ///< ny
  double floor;                     ///< root mean square up to which a signal is 0
};

Inputs moving_inputs(const Eigen::MatrixXd& deviations, double resolution) {
  Inputs inputs{{}, {}, deviations.rows(), 0.0};
  for (Eigen::Index j = 0; j < inputs.all; ++j)
    inputs.floor = std::max(inputs.floor, resolution * root_mean_square(deviations.row(j).transpose()));
  for (Eigen::Index j = 0; j < inputs.all; ++j)
    if (root_mean_square(deviations.row(j).transpose()) > inputs.floor)
      inputs.of_cv.push_back(j);
  inputs.moving = deviations(inputs.of_cv, Eigen::all);
  return inputs;
}

/// Models of all orders for `target`, fitted to its first `samples` samples.
std::vector<OutputErrorFit> fitted(const Eigen::VectorXd& target, const Inputs& inputs,
                                   const std::vector<Eigen::Index>& orders, Eigen::Index delay,
                                   Eigen::Index samples, const DesignedOutputOptions& options) {
  return OutputErrorFits(inputs.moving.leftCols(samples), options.max_iterations)
      .fit(target.head(samples), orders, delay);
}

/// The criterion of a model, signed so that larger is better. The last `N` - `samples` samples were kept for
/// validation.
double merit_of(const OutputErrorFit& found, const Eigen::VectorXd& target, const Inputs& inputs,
                Eigen::Index samples, DesignedOrderCriterion criterion) {
  if (criterion == DesignedOrderCriterion::bic) {
    const auto n = static_cast<double>(samples);
    const auto p = static_cast<double>(found.model.order().parameter_count());
    return -n * std::log(found.loss) - p * std::log(n);
  }
  if (criterion == DesignedOrderCriterion::record_fit)
    return percent_fit(target.head(samples), found.loss * static_cast<double>(samples));
  const Eigen::Index kept = target.size() - samples;
  return percent_fit(target.tail(kept), simulate(found.model, inputs.moving).tail(kept));
}

/// The number of samples to which the compared models are fitted.
Eigen::Index samples_of_trials(Eigen::Index N, const DesignedOutputOptions& options) {
  if (options.criterion != DesignedOrderCriterion::validation_fit)
    return N;
  return N - std::max<Eigen::Index>(2, std::lround(options.validation_share * static_cast<double>(N)));
}

/// The model with a path for every eps; the path of an eps that stands still is 0.
PolynomialModel with_all_paths(const PolynomialModel& model, const Inputs& inputs) {
  PolynomialModel full = model;
  full.inputs.assign(static_cast<std::size_t>(inputs.all), InputPath{});
  for (std::size_t j = 0; j < inputs.of_cv.size(); ++j)
    full.inputs[static_cast<std::size_t>(inputs.of_cv[j])] = model.inputs[j];
  return full;
}

/// One row of S_d (delay 0, since the setpoint acts on the control error at once) or of Delta G K (delay 1).
ClosedLoopModel identified_row(const Eigen::VectorXd& target, const Inputs& inputs, Eigen::Index delay,
                               const DesignedOutputOptions& options) {
  ClosedLoopModel row;
  row.model.inputs.assign(static_cast<std::size_t>(inputs.all), InputPath{});
  if (root_mean_square(target) <= inputs.floor) {
    row.status = ClosedLoopModelStatus::zero;
    return row;
  }
  if (inputs.of_cv.empty())
    return row;
  const Eigen::Index N = target.size();
  const Eigen::Index samples = samples_of_trials(N, options);
  const std::vector<OutputErrorFit> trials = fitted(target, inputs, options.orders, delay, samples, options);
  std::optional<std::size_t> best;
  double most = kNaN;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double merit = merit_of(trials[i], target, inputs, samples, options.criterion);
    if (std::isnan(merit) || (best && !(merit > most)))
      continue;
    best = i;
    most = merit;
  }
  if (!best)
    return row;
  row.order = options.orders[*best];
  const PolynomialModel model = samples == N
                                    ? trials[*best].model
                                    : fitted(target, inputs, {row.order}, delay, N, options).front().model;
  row.fit = percent_fit(target, simulate(model, inputs.moving));
  row.model = with_all_paths(model, inputs);
  row.status = ClosedLoopModelStatus::identified;
  return row;
}

bool is_found(const ClosedLoopModel& row) {
  return row.status != ClosedLoopModelStatus::no_model;
}

void require_record(const Signals& y, const Signals& y_hat, const Signals& y_set) {
  const auto shape = [](const Signals& x) { return fmt::format("{} x {}", x.rows(), x.cols()); };
  if (y.rows() != y_hat.rows() || y.rows() != y_set.rows() || y.cols() != y_hat.cols() ||
      y.cols() != y_set.cols())
    throw InputError("shapes of y, y_hat and y_set",
                     fmt::format("{}, {} and {}", shape(y), shape(y_hat), shape(y_set)), "equal shapes");
  if (y.rows() == 0)
    throw InputError("CVs of a designed output", "none", "1 or more, each with a setpoint");
  if (!y.allFinite() || !y_hat.allFinite() || !y_set.allFinite())
    throw InputError("y, y_hat and y_set", "a value that is not finite", "finite values");
}

}  // namespace

void DesignedOutputOptions::validate() const {
  if (orders.empty())
    throw InputError("orders of a designed output", "none", "1 or more");
  for (const Eigen::Index order : orders)
    if (order < 1)
      throw InputError("order of a designed output", fmt::format("{}", order), "1 or more");
  if (!(validation_share > 0.0 && validation_share < 1.0))
    throw InputError("validation share", fmt::format("{}", validation_share), "above 0 and below 1");
  if (max_iterations < 1)
    throw InputError("iterations of a search", fmt::format("{}", max_iterations), "1 or more");
  if (!(resolution >= 0.0 && resolution < 1.0))
    throw InputError("resolution of a designed output", fmt::format("{}", resolution),
                     "0 or more and below 1");
}

bool DesignedOutput::has(Eigen::Index i) const {
  return is_found(sensitivity[static_cast<std::size_t>(i)]) &&
         std::all_of(mismatch.begin(), mismatch.end(), is_found);
}

Eigen::MatrixXd controller_inputs(const Signals& y, const Signals& y_hat, const Signals& y_set) {
  require_record(y, y_hat, y_set);
  return y_set - y + y_hat;
}

DesignedOutput designed_output(const Signals& y, const Signals& y_hat, const Signals& y_set,
                               const DesignedOutputOptions& options) {
  options.validate();
  DesignedOutput result;
  result.eps = controller_inputs(y, y_hat, y_set);
  const Eigen::VectorXd start = y_set.col(0);
  const Eigen::MatrixXd deviations = result.eps.colwise() - start;
  const Inputs inputs = moving_inputs(deviations, options.resolution);

  Eigen::MatrixXd reference = deviations;  // (I + Delta G K) eps = y_set - v_s (3.6)
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    result.sensitivity.push_back(identified_row((y_set.row(i) - y.row(i)).transpose(), inputs, 0, options));
    result.mismatch.push_back(identified_row((y.row(i) - y_hat.row(i)).transpose(), inputs, 1, options));
    reference.row(i) += simulate(result.mismatch.back().model, deviations).transpose();
  }
  result.y0 = Eigen::MatrixXd::Constant(y.rows(), y.cols(), kNaN);
  for (Eigen::Index i = 0; i < y.rows(); ++i)
    if (result.has(i))
      result.y0.row(i) =
          y_set.row(i) -
          simulate(result.sensitivity[static_cast<std::size_t>(i)].model, reference).transpose();
  return result;
}

}  // namespace mpm
