#include "analysis/identification/prediction_error_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/identification/arx.hpp"
#include "analysis/identification/least_squares.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

void narrow(Eigen::VectorXd& polynomial, double radius) {
  polynomial = stabilised(polynomial, radius);
}

/// Coefficients of an ARX regression of any rank; 0 when there are too few samples.
Eigen::VectorXd regression(const ModelOrder& order, const Eigen::VectorXd& y, const Eigen::MatrixXd& u) {
  const Eigen::Index p = order.parameter_count();
  const Eigen::Index n = y.size() - order.memory();
  if (p == 0 || n < p)
    return Eigen::VectorXd::Zero(p);
  return least_squares(arx_regressors(order, y, u, order.memory()), y.tail(n), kRankTolerance).x;
}

/// Orders of the ARX models to start from: the lowest order that a common denominator can have, and higher
/// ones, as long as there are three samples per parameter.
std::vector<Eigen::Index> arx_orders(const ModelOrder& order, Eigen::Index samples) {
  Eigen::Index largest = 1;
  Eigen::Index sum = order.nd;
  for (const PathOrder& path : order.inputs) {
    largest = std::max(largest, path.nf);
    sum += path.nf;
  }
  const Eigen::Index affordable =
      std::max<Eigen::Index>(1, samples / (3 * (1 + static_cast<Eigen::Index>(order.inputs.size()))));
  std::vector<Eigen::Index> orders;
  for (const Eigen::Index n : {largest, sum, kLongestArx})
    orders.push_back(std::clamp<Eigen::Index>(n, 1, affordable));
  std::sort(orders.begin(), orders.end());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
  return orders;
}

/// Finds the F of the path that comes nearest to the response w of the input u, by Steiglitz and McBride.
Eigen::VectorXd reduced_denominator(const Eigen::VectorXd& w, const Eigen::VectorXd& u, const PathOrder& path,
                                    const PredictionErrorOptions& options) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const ModelOrder order{path.nf, {{path.nb, 0, path.delay}}, 0, 0};
  Eigen::VectorXd F = one;
  Eigen::VectorXd best = one;
  double least = kInfinity;
  for (int round = 0; round < kReductionRounds && path.nf > 0; ++round) {
    const Eigen::VectorXd filtered_w = filter(one, F, w, 0, options.start);
    const Eigen::VectorXd filtered_u = filter(one, F, u, 0, options.start);
    const Eigen::VectorXd x = regression(order, filtered_w, filtered_u.transpose());
    F.resize(path.nf + 1);
    F << 1.0, x.head(path.nf);
    narrow(F, options.largest_radius);
    const double error = (w - filter(x.tail(path.nb), F, u, path.delay, options.start)).squaredNorm();
    if (error < least) {
      least = error;
      best = F;
    }
  }
  return best.size() == path.nf + 1 ? best : Eigen::VectorXd(Eigen::VectorXd::Unit(path.nf + 1, 0));
}

/// Fits all B by least squares on y, with the F known.
void fit_numerators(PolynomialModel& model, const Eigen::VectorXd& y, const Eigen::MatrixXd& u,
                    const PredictionErrorOptions& options) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const ModelOrder order = model.order();
  Eigen::Index count = 0;
  for (const PathOrder& path : order.inputs)
    count += path.nb;
  Eigen::MatrixXd regressors(y.size(), count);
  Eigen::Index column = 0;
  for (std::size_t j = 0; j < model.inputs.size(); ++j) {
    const Eigen::VectorXd input = u.row(static_cast<Eigen::Index>(j)).transpose();
    const Eigen::VectorXd filtered = filter(one, model.inputs[j].F, input, 0, options.start);
    for (Eigen::Index i = 0; i < order.inputs[j].nb; ++i)
      regressors.col(column++) = delayed(filtered, order.inputs[j].delay + i, options.start);
  }
  const Eigen::Index n = y.size() - options.first_sample;
  const Eigen::VectorXd x = least_squares(regressors.bottomRows(n), y.tail(n), kRankTolerance).x;
  column = 0;
  for (InputPath& path : model.inputs) {
    path.B = x.segment(column, path.B.size());
    column += path.B.size();
  }
}

/// Fits C and D to the noise v, by Hannan and Rissanen.
void fit_noise(PolynomialModel& model, const Eigen::VectorXd& v, double radius) {
  const Eigen::Index nc = model.C.size() - 1;
  const Eigen::Index nd = model.D.size() - 1;
  if (nc + nd == 0)
    return;
  const Eigen::Index length = std::min<Eigen::Index>(kLongestArx + nc + nd, v.size() / 4);
  const ModelOrder autoregression{length, {}, 0, 0};
  const Eigen::MatrixXd none(0, v.size());
  Eigen::VectorXd whitening(length + 1);
  whitening << 1.0, regression(autoregression, v, none);
  const Eigen::VectorXd innovations = filter(whitening, Eigen::VectorXd::Ones(1), v).tail(v.size() - length);
  ModelOrder order{nd, {}, 0, 0};
  Eigen::VectorXd x;
  if (nc > 0) {
    order.inputs.push_back({nc, 0, 1});
    x = regression(order, v.tail(innovations.size()), innovations.transpose());
  } else {
    x = regression(order, v, none);
  }
  model.D.tail(nd) = x.head(nd);
  model.C.tail(nc) = x.tail(nc);
  narrow(model.C, radius);
  narrow(model.D, radius);
}

PolynomialModel start_from_arx(const Eigen::VectorXd& y, const Eigen::MatrixXd& u, const ModelOrder& order,
                               Eigen::Index arx_length, const PredictionErrorOptions& options) {
  ModelOrder high{arx_length, order.inputs, 0, 0};
  for (PathOrder& path : high.inputs)
    path = {std::max(path.nb, arx_length), 0, path.delay};
  PolynomialModel arx = model_from_parameters(high, regression(high, y, u));
  narrow(arx.A, options.largest_radius);

  PolynomialModel model = model_from_parameters(order, Eigen::VectorXd::Zero(order.parameter_count()));
  for (std::size_t j = 0; j < model.inputs.size(); ++j) {
    const Eigen::VectorXd input = u.row(static_cast<Eigen::Index>(j)).transpose();
    const Eigen::VectorXd w = filter(arx.inputs[j].B, arx.A, input, arx.inputs[j].delay, options.start);
    model.inputs[j].F = reduced_denominator(w, input, order.inputs[j], options);
  }
  fit_numerators(model, y, u, options);
  fit_noise(model, y - simulate(model, u, options.start), options.largest_radius);
  return model;
}

}  // namespace

std::vector<PolynomialModel> prediction_error_starts(const Eigen::Ref<const Eigen::VectorXd>& y,
                                                     const Eigen::Ref<const Eigen::MatrixXd>& u,
                                                     const ModelOrder& order,
                                                     const PredictionErrorOptions& options) {
  // The search refuses roots outside the largest radius, so rounding must not put a start at the border
  // outside.
  PredictionErrorOptions inner = options;
  inner.largest_radius = 1.0 - 2.0 * (1.0 - options.largest_radius);
  std::vector<std::pair<double, PolynomialModel>> starts;
  const Eigen::Index n = y.size() - options.first_sample;
  for (const Eigen::Index length : arx_orders(order, n)) {
    PolynomialModel model = start_from_arx(y, u, order, length, inner);
    const double sum = prediction_errors(model, y, u, options.start).tail(n).squaredNorm();
    if (std::isfinite(sum))
      starts.emplace_back(sum, std::move(model));
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PolynomialModel> models;
  for (auto& [sum, model] : starts)
    models.push_back(std::move(model));
  return models;
}

}  // namespace mpm
