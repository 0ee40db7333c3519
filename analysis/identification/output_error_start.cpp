#include "analysis/identification/output_error_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/prediction_error_start.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "plants/non_finite.hpp"

namespace mpm {
namespace {

// Rounds that move no coefficient of F by more than this give what the one before gave.
constexpr double kSameDenominator = 1e-9;
// Least pivot of X'X with a diagonal of 1. The rounding of the products, 1e-16, is then 1e-4 of it.
constexpr double kLeastPivot = 1e-12;

/// The coefficients x of the regression of signal `target` on the columns, from their products; where these
/// leave too few digits, by `least_squares` from the columns.
Eigen::VectorXd lagged_regression(const ShiftedSignals& signals, const std::vector<LaggedColumns>& columns,
                                  Eigen::Index target, Eigen::Index first) {
  const Eigen::MatrixXd products = lagged_products(signals, columns, first);
  const Eigen::VectorXd with = lagged_products_with(signals, columns, target, first);
  const Eigen::VectorXd norms = products.diagonal().cwiseMax(0.0).cwiseSqrt();
  if (norms.minCoeff() > 0.0) {
    const Eigen::VectorXd scale = norms.cwiseInverse();
    const Eigen::LLT<Eigen::MatrixXd> factor(scale.asDiagonal() * products * scale.asDiagonal());
    if (factor.info() == Eigen::Success && factor.matrixLLT().diagonal().minCoeff() > std::sqrt(kLeastPivot))
      return scale.asDiagonal() * factor.solve(scale.asDiagonal() * with);
  }
  return least_squares(lagged_matrix(signals, columns, first),
                       signals[target].tail(signals.samples() - first))
      .x;
}

/// Lengths of the ARX models to start from, as `prediction_error_starts` has them.
std::vector<Eigen::Index> arx_lengths(Eigen::Index nu, Eigen::Index nf, Eigen::Index samples) {
  const Eigen::Index affordable = std::max<Eigen::Index>(1, samples / (3 * (1 + nu)));
  std::vector<Eigen::Index> lengths;
  for (const Eigen::Index length : {nf, nu * nf, kLongestArx})
    lengths.push_back(std::clamp<Eigen::Index>(length, 1, affordable));
  std::sort(lengths.begin(), lengths.end());
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  return lengths;
}

/// Coefficients of a monic polynomial from those behind the 1, brought inside.
Eigen::VectorXd stable_monic(const Eigen::Ref<const Eigen::VectorXd>& tail, double radius) {
  Eigen::VectorXd polynomial(tail.size() + 1);
  polynomial << 1.0, tail;
  return stabilised(polynomial, radius);
}

}  // namespace

OutputErrorStarts::OutputErrorStarts(const OutputErrorProblem& problem) : problem_(problem) {}

OutputErrorCoefficients OutputErrorStarts::best(Eigen::Index nb, Eigen::Index nf) {
  const Eigen::Index nu = problem_.u.count();
  OutputErrorCoefficients best{Eigen::MatrixXd::Zero(nb, nu), Eigen::MatrixXd::Zero(nf + 1, nu)};
  best.F.row(0).setOnes();
  double least = kInfinity;
  for (const Eigen::Index length : arx_lengths(nu, nf, problem_.y.size())) {
    OutputErrorCoefficients model = reduced(responses({length, std::max(nb, length)}), nb, nf);
    fit_numerators(model);
    const double loss = output_error_loss(problem_, model);
    if (loss < least) {
      least = loss;
      best = model;
    }
  }
  return best;
}

const SignalBank& OutputErrorStarts::responses(const ArxOrder& order) {
  if (const auto found = responses_.find(order); found != responses_.end())
    return found->second;
  const auto [na, nb] = order;
  const Eigen::Index nu = problem_.u.count(), N = problem_.y.size();
  const Eigen::Index first = std::max(na, problem_.delay + nb - 1);
  ShiftedSignals signals(nu + 1, N, first);
  signals[nu] = problem_.y;
  std::vector<LaggedColumns> columns{{nu, 1, na}};
  for (Eigen::Index j = 0; j < nu; ++j) {
    signals[j] = problem_.u[j];
    columns.push_back({j, problem_.delay, nb});
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(na + nu * nb);
  if (N - first >= x.size())
    x = lagged_regression(signals, columns, nu, first);

  const Eigen::VectorXd A = stable_monic(-x.head(na), problem_.largest_radius);
  SignalBank inputs(nu, N, problem_.delay + nb);
  SignalBank w(nu, N, na);
  for (Eigen::Index j = 0; j < nu; ++j)
    inputs[j] = problem_.u[j];
  filter_bank(x.tail(nu * nb).reshaped(nb, nu), A.replicate(1, nu), problem_.delay, inputs, w);
  SignalBank both(2 * nu, N, 0);
  for (Eigen::Index j = 0; j < nu; ++j) {
    both[j] = w[j];
    both[nu + j] = problem_.u[j];
  }
  return responses_.emplace(order, std::move(both)).first->second;
}

/// F of each path nearest to the response w_j of its input, by Steiglitz and McBride; B is not set.
OutputErrorCoefficients OutputErrorStarts::reduced(const SignalBank& responses, Eigen::Index nb,
                                                   Eigen::Index nf) const {
  const Eigen::Index nu = responses.count() / 2, N = responses.samples();
  const Eigen::Index first = std::max(nf, problem_.delay + nb - 1);
  OutputErrorCoefficients model{Eigen::MatrixXd::Zero(nb, nu), Eigen::MatrixXd::Zero(nf + 1, nu)};
  model.F.row(0).setOnes();
  Eigen::MatrixXd F = model.F, B = model.B;
  Eigen::VectorXd least = Eigen::VectorXd::Constant(nu, kInfinity);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 2 * nu);
  SignalBank filtered(2 * nu, N, first + 1);
  SignalBank path(2 * nu, N, first + 1);
  ShiftedSignals shifted(2 * nu, N, first);
  filter_bank(one, one, 0, responses, filtered);
  if (N - first < nf + nb)
    return model;
  for (int round = 0; round < kReductionRounds; ++round) {
    const Eigen::MatrixXd before = F;
    for (Eigen::Index j = 0; j < 2 * nu; ++j)
      shifted[j] = filtered[j];
    for (Eigen::Index j = 0; j < nu; ++j) {
      const Eigen::VectorXd x =
          lagged_regression(shifted, {{j, 1, nf}, {nu + j, problem_.delay, nb}}, j, first);
      F.col(j) = stable_monic(-x.head(nf), problem_.largest_radius);
      B.col(j) = x.tail(nb);
    }
    filter_bank(one, F.replicate(1, 2), 0, responses, filtered);
    filter_bank(B.replicate(1, 2), one, problem_.delay, filtered, path);
    for (Eigen::Index j = 0; j < nu; ++j) {
      const double error = (responses[j] - path[nu + j]).squaredNorm();
      if (error < least(j)) {
        least(j) = error;
        model.F.col(j) = F.col(j);
      }
    }
    if ((F - before).cwiseAbs().maxCoeff() < kSameDenominator)
      break;
  }
  return model;
}

/// All B by least squares on y, the F being known.
void OutputErrorStarts::fit_numerators(OutputErrorCoefficients& model) const {
  const Eigen::Index nu = model.B.cols(), nb = model.B.rows(), N = problem_.y.size();
  const Eigen::Index memory = std::max(nb + problem_.delay, model.F.rows());
  SignalBank filtered(nu, N, memory);
  filter_bank(Eigen::MatrixXd::Ones(1, nu), model.F, 0, problem_.u, filtered);
  ShiftedSignals shifted(nu + 1, N, memory);
  shifted[nu] = problem_.y;
  std::vector<LaggedColumns> columns;
  for (Eigen::Index j = 0; j < nu; ++j) {
    shifted[j] = filtered[j];
    columns.push_back({j, problem_.delay, nb});
  }
  model.B = lagged_regression(shifted, columns, nu, 0).reshaped(nb, nu);
}

}  // namespace mpm
