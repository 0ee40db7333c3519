#include "analysis/identification/output_error_start.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "analysis/identification/lane_cholesky.hpp"
#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/prediction_error_start.hpp"
#include "analysis/statistics/discrete_filter.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

// A round that moves no coefficient of F by more than this gives the same result as the round before.
constexpr double kSameDenominator = 1e-9;
// Least pivot of X'X with a diagonal of 1. The rounding of the products, 1e-16, is then 1e-4 of it, and one
// step of refinement reduces that to 1e-8.
constexpr double kLeastPivot = 1e-12;
// Above this pivot the products alone leave 6 digits.
constexpr double kSafePivot = 1e-10;

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

/// The monic polynomial with the coefficients `tail` after the 1, with its roots brought within `radius`.
Eigen::VectorXd stable_monic(const Eigen::Ref<const Eigen::VectorXd>& tail, double radius) {
  Eigen::VectorXd polynomial(tail.size() + 1);
  polynomial << 1.0, tail;
  return stabilised(polynomial, radius);
}

// Where the response to input j and the input itself stand among the responses.
Eigen::Index response_place(Eigen::Index j) {
  return 8 * (j / 4) + j % 4;
}
Eigen::Index input_place(Eigen::Index j) {
  return response_place(j) + 4;
}
Eigen::Index places(Eigen::Index inputs) {
  return 8 * ((inputs + 3) / 4);
}

/// For each of the four responses of a group, the sum of squares of its difference from the response in
/// `path`.
Eigen::Array4d squared_distances(const SignalBank& responses, const SignalBank& path, Eigen::Index group) {
  constexpr Eigen::Index kTogether = 4;  // number of sums side by side, so that none waits for the one before
  Eigen::Array<double, 4, kTogether> sums = Eigen::Array<double, 4, kTogether>::Zero();
  const double* w = responses.at(group, 0);
  const double* from = path.at(group, 0) + 4;
  const Eigen::Index N = responses.samples();
  for (Eigen::Index k = 0; k < N; k += kTogether)
    for (Eigen::Index i = 0; i < std::min(kTogether, N - k); ++i, w += 8, from += 8)
      sums.col(i) += (Eigen::Map<const Eigen::Array4d>(w) - Eigen::Map<const Eigen::Array4d>(from)).square();
  return sums.rowwise().sum();
}

}  // namespace

OutputErrorStarts::OutputErrorStarts(const Eigen::Ref<const Eigen::MatrixXd>& u,
                                     const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index delay,
                                     Eigen::Index rows, double largest_radius, OutputErrors& errors)
    : nu_(u.rows()),
      delay_(delay),
      largest_radius_(largest_radius),
      errors_(errors),
      signals_(nu_ + 1, u.cols(), 0),
      inputs_(places(nu_), u.cols(), std::max(nu_ * rows, kLongestArx) + delay),
      filtered_signals_(nu_ + 1, u.cols(), rows),
      filtered_(places(nu_), u.cols(), rows),
      path_(places(nu_), u.cols(), rows) {
  for (Eigen::Index j = 0; j < nu_; ++j)
    signals_[j] = inputs_[response_place(j)] = inputs_[input_place(j)] = u.row(j).transpose();
  signals_[nu_] = y;
}

/// Returns the coefficients x of the regression of signal `target` on the columns X, from their products in
/// `sums_`: X'X x = X'y. If the products leave few digits, x is refined by X'(y - X x). If they leave too
/// few, x comes from the columns by `least_squares`.
Eigen::VectorXd OutputErrorStarts::regression(const SignalBank& signals,
                                              const std::vector<LaggedColumns>& columns, Eigen::Index target,
                                              Eigen::Index first) {
  const auto y = signals[target].tail(signals.samples() - first);
  Eigen::MatrixXd products = sums_.products(columns);
  const Eigen::VectorXd norms = products.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd scale = norms.cwiseInverse();
  products.array().colwise() *= scale.array();
  products.array().rowwise() *= scale.transpose().array();
  if (!(norms.minCoeff() > 0.0) || !factor_.compute(products, kLeastPivot))
    return least_squares(lagged_matrix(signals, columns, first), y).x;
  const auto solved = [&](const Eigen::VectorXd& right) -> Eigen::VectorXd {
    return factor_.solve(right.cwiseProduct(scale)).cwiseProduct(scale);
  };
  Eigen::VectorXd x = solved(sums_.products_with(columns, target));
  if (factor_.least_pivot() < kSafePivot) {
    const Eigen::MatrixXd X = lagged_matrix(signals, columns, first);
    x += solved(X.transpose() * (y - X * x));
  }
  return x;
}

OutputErrorCoefficients OutputErrorStarts::best(Eigen::Index nb, Eigen::Index nf) {
  OutputErrorCoefficients best{Eigen::MatrixXd::Zero(nb, nu_), Eigen::MatrixXd::Zero(nf + 1, nu_)};
  best.F.row(0).setOnes();
  double least = kInfinity;
  for (const Eigen::Index length : arx_lengths(nu_, nf, signals_.samples())) {
    OutputErrorCoefficients model = reduced(responses({length, std::max(nb, length)}), nb, nf);
    fit_numerators(model);
    const bool allowed = model.B.allFinite() && model.F.allFinite() && roots_within(model.F, largest_radius_);
    const double cost = allowed ? errors_.cost(model) : kInfinity;
    if (cost < least) {
      least = cost;
      best = model;
    }
  }
  return best;
}

const SignalBank& OutputErrorStarts::responses(const ArxOrder& order) {
  if (const auto found = responses_.find(order); found != responses_.end())
    return found->second;
  const auto [na, nb] = order;
  const Eigen::Index N = signals_.samples();
  const Eigen::Index first = std::max(na, delay_ + nb - 1);
  std::vector<LaggedColumns> columns{{nu_, 1, na}};
  for (Eigen::Index j = 0; j < nu_; ++j)
    columns.push_back({j, delay_, nb});
  Eigen::VectorXd x = Eigen::VectorXd::Zero(na + nu_ * nb);
  sums_.compute(signals_, nu_ + 1, first, first);
  if (N - first >= x.size())
    x = regression(signals_, columns, nu_, first);

  const Eigen::VectorXd A = stable_monic(-x.head(na), largest_radius_);
  Eigen::MatrixXd numerators = Eigen::MatrixXd::Zero(delay_ + nb, inputs_.count());
  Eigen::MatrixXd denominators = Eigen::MatrixXd::Zero(na + 1, inputs_.count());
  for (Eigen::Index j = 0; j < nu_; ++j) {
    numerators.col(response_place(j)).tail(nb) = x.segment(na + j * nb, nb);
    denominators.col(response_place(j)) = A;
    numerators(0, input_place(j)) = 1.0;
  }
  SignalBank responses(inputs_.count(), N, na);
  filter_bank(numerators, denominators, 0, inputs_, responses);
  return responses_.emplace(order, std::move(responses)).first->second;
}

/// Finds the F of each path that comes nearest to the response w_j of its input, by Steiglitz and McBride; B
/// is not set.
OutputErrorCoefficients OutputErrorStarts::reduced(const SignalBank& responses, Eigen::Index nb,
                                                   Eigen::Index nf) {
  const Eigen::Index N = responses.samples();
  const Eigen::Index first = std::max(nf, delay_ + nb - 1);
  OutputErrorCoefficients model{Eigen::MatrixXd::Zero(nb, nu_), Eigen::MatrixXd::Zero(nf + 1, nu_)};
  model.F.row(0).setOnes();
  if (N - first < nf + nb)
    return model;
  Eigen::MatrixXd F = model.F;
  Eigen::MatrixXd denominators = Eigen::MatrixXd::Zero(first + 1, responses.count());
  Eigen::MatrixXd numerators = denominators;  // none for the responses
  Eigen::VectorXd least = Eigen::VectorXd::Constant(nu_, kInfinity);
  for (Eigen::Index group = 0; group < responses.groups(); ++group)
    std::copy_n(responses.at(group, 0), 8 * N, filtered_.at(group, 0));
  for (int round = 0; round < kReductionRounds; ++round) {
    const Eigen::MatrixXd before = F;
    sums_.compute(filtered_, responses.count(), first, first, LagPairs::partners);
    for (Eigen::Index j = 0; j < nu_; ++j) {
      const Eigen::Index w = response_place(j), u = input_place(j);
      const Eigen::VectorXd x = regression(filtered_, {{w, 1, nf}, {u, delay_, nb}}, w, first);
      F.col(j) = stable_monic(-x.head(nf), largest_radius_);
      denominators.col(w).head(nf + 1) = denominators.col(u).head(nf + 1) = F.col(j);
      numerators.col(u).segment(delay_, nb) = x.tail(nb);
    }
    filter_paths(denominators, numerators, nullptr, responses, path_, filtered_);
    for (Eigen::Index group = 0; group < responses.groups(); ++group) {
      const Eigen::Array4d errors = squared_distances(responses, path_, group);
      for (Eigen::Index j = 4 * group; j < std::min(nu_, 4 * group + 4); ++j) {
        if (errors(j % 4) < least(j)) {
          least(j) = errors(j % 4);
          model.F.col(j) = F.col(j);
        }
      }
    }
    if ((F - before).cwiseAbs().maxCoeff() < kSameDenominator)
      break;
  }
  return model;
}

/// Fits all B by least squares on y, with the F known.
void OutputErrorStarts::fit_numerators(OutputErrorCoefficients& model) {
  const Eigen::Index nb = model.B.rows();
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(model.F.rows(), nu_ + 1);  // the output as it is
  F.leftCols(nu_) = model.F;
  filter_bank(Eigen::MatrixXd::Ones(1, nu_ + 1), F, 0, signals_, filtered_signals_);
  std::vector<LaggedColumns> columns;
  for (Eigen::Index j = 0; j < nu_; ++j)
    columns.push_back({j, delay_, nb});
  sums_.compute(filtered_signals_, nu_, delay_ + nb - 1, 0);
  model.B = regression(filtered_signals_, columns, nu_, 0).reshaped(nb, nu_);
}

}  // namespace mpm
