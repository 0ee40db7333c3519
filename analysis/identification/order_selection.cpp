#include "analysis/identification/order_selection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "analysis/identification/prediction_error_fit.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

bool is_regression(const ModelOrder& order) {
  return order.nc == 0 && order.nd == 0 &&
         std::all_of(order.inputs.begin(), order.inputs.end(), [](const PathOrder& p) { return p.nf == 0; });
}

PredictionErrorOptions with_common_samples(PredictionErrorOptions fit,
                                           const std::vector<ModelOrder>& candidates) {
  for (const ModelOrder& order : candidates)
    if (is_regression(order))
      fit.first_sample = std::max(fit.first_sample, order.memory());
  return fit;
}

/// The criterion, with a sign such that smaller is better, and how much worse a smaller model may be.
struct Score {
  double value;
  double allowance;
};

Score score(const OrderCandidate& candidate, const OrderSelectionOptions& options) {
  switch (options.criterion) {
    case OrderCriterion::validation_fit:
      return {-candidate.validation_fit, options.tolerance};
    case OrderCriterion::validation_loss:
      return {candidate.validation_loss, options.tolerance * candidate.validation_loss};
    case OrderCriterion::aic:
      return {candidate.aic, options.tolerance};
    case OrderCriterion::bic:
      break;
  }
  return {candidate.bic, options.tolerance};
}

OrderCandidate tried(const Eigen::Ref<const Eigen::VectorXd>& y, const Eigen::Ref<const Eigen::MatrixXd>& u,
                     const ModelOrder& order, Eigen::Index estimation, const PredictionErrorOptions& fit) {
  OrderCandidate candidate;
  candidate.order = order;
  candidate.identification = identify(y.head(estimation), u.leftCols(estimation), order, fit);
  const PolynomialModel& model = candidate.identification.model;
  const Eigen::Index validation = y.size() - estimation;
  const Eigen::VectorXd tail = y.tail(validation);
  candidate.validation_fit = percent_fit(tail, simulate(model, u, fit.start).tail(validation));
  candidate.validation_loss = prediction_errors(model, y, u, fit.start).tail(validation).squaredNorm() /
                              static_cast<double>(validation);
  const auto n = static_cast<double>(candidate.identification.samples);
  const auto p = static_cast<double>(order.parameter_count());
  const double fitted = n * std::log(candidate.identification.loss);
  candidate.aic = fitted + 2.0 * p;
  candidate.bic = fitted + p * std::log(n);
  return candidate;
}

std::optional<std::size_t> best_order_candidate(const std::vector<OrderCandidate>& candidates,
                                                const OrderSelectionOptions& options) {
  const auto eligible = [&options](const OrderCandidate& candidate) {
    // A loss of 0 has the logarithm -infinity, which is the best there is.
    return is_usable(candidate.identification.status) && !std::isnan(score(candidate, options).value);
  };
  std::optional<std::size_t> lowest;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (eligible(candidates[i]) &&
        (!lowest || score(candidates[i], options).value < score(candidates[*lowest], options).value))
      lowest = i;
  if (!lowest)
    return lowest;
  const Score limit = score(candidates[*lowest], options);
  std::optional<std::size_t> best = lowest;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (eligible(candidates[i]) && score(candidates[i], options).value <= limit.value + limit.allowance &&
        candidates[i].order.parameter_count() < candidates[*best].order.parameter_count())
      best = i;
  return best;
}

void require_grid(const std::string& name, const std::vector<Eigen::Index>& values) {
  if (values.empty())
    throw InputError("values of " + name + " in a grid of orders", "none", "1 or more");
}

}  // namespace

std::vector<ModelOrder> order_candidates(const OrderGrid& grid, Eigen::Index nu) {
  require_grid("na", grid.na);
  require_grid("nb", grid.nb);
  require_grid("nf", grid.nf);
  require_grid("nc", grid.nc);
  require_grid("nd", grid.nd);
  require_grid("delay", grid.delay);
  std::vector<ModelOrder> candidates;
  for (const Eigen::Index na : grid.na)
    for (const Eigen::Index nb : grid.nb)
      for (const Eigen::Index nf : grid.nf)
        for (const Eigen::Index nc : grid.nc)
          for (const Eigen::Index nd : grid.nd)
            for (const Eigen::Index delay : grid.delay) {
              candidates.push_back(box_jenkins_order(nu, nb, nf, nc, nd, delay));
              candidates.back().na = na;
              candidates.back().validate(nu);
            }
  return candidates;
}

void OrderSelectionOptions::validate() const {
  if (!(validation_share > 0.0 && validation_share < 1.0))
    throw InputError("validation share", fmt::format("{}", validation_share), "above 0 and below 1");
  if (!(tolerance >= 0.0))
    throw InputError("tolerance of an order selection", fmt::format("{}", tolerance), "0 or more");
  fit.validate();
}

OrderSelection select_order(const Eigen::Ref<const Eigen::VectorXd>& y,
                            const Eigen::Ref<const Eigen::MatrixXd>& u,
                            const std::vector<ModelOrder>& candidates, const OrderSelectionOptions& options) {
  options.validate();
  if (candidates.empty())
    throw InputError("orders to select from", "none", "1 or more");
  if (y.size() != u.cols())
    throw InputError("lengths of output and inputs", fmt::format("{} and {}", y.size(), u.cols()),
                     "equal lengths");
  const auto N = static_cast<double>(y.size());
  const auto estimation = static_cast<Eigen::Index>(std::lround(N * (1.0 - options.validation_share)));
  const PredictionErrorOptions fit = with_common_samples(options.fit, candidates);
  OrderSelection selection;
  for (const ModelOrder& order : candidates)
    selection.candidates.push_back(tried(y, u, order, estimation, fit));
  selection.best = best_order_candidate(selection.candidates, options);
  return selection;
}

}  // namespace mpm
