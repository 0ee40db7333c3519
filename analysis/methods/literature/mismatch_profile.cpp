#include "analysis/methods/literature/mismatch_profile.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/mismatch_search.hpp"
#include "analysis/statistics/chi_squared.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// V(v) for the error `left` after the mismatch v. The last Cholesky pivot of the products of a constant, the
/// past of `left` and `left` itself is the part of `left` that the others do not explain.
double noise_squares(const Eigen::VectorXd& left, Eigen::Index p) {
  const Eigen::Index n = left.size() - p;
  Eigen::MatrixXd columns(n, p + 2);
  columns.col(0).setOnes();
  for (Eigen::Index lag = 0; lag <= p; ++lag)
    columns.col(p + 1 - lag) = left.segment(p - lag, n);
  const Eigen::MatrixXd products = columns.transpose() * columns;
  const Eigen::LLT<Eigen::MatrixXd> root(products);
  const double pivot = root.matrixL()(p + 1, p + 1);
  return root.info() == Eigen::Success ? pivot * pivot : 0.0;
}

}  // namespace

std::vector<ProfiledMismatch> profiled_mismatches(const Eigen::Ref<const Eigen::VectorXd>& e,
                                                  const Eigen::Ref<const Eigen::VectorXd>& input,
                                                  const TransferFunction& channel, double sample_time,
                                                  Eigen::Index order, double confidence) {
  if (input.size() < e.size() || e.size() < 3 * order + 10)
    throw InputError("samples of a simulation error and the input",
                     fmt::format("{} and {}", e.size(), input.size()),
                     fmt::format("{} or more, of the input as many at least", 3 * order + 10));
  if (channel.is_zero())
    throw InputError("channel of a mismatch", "one without effect", "one with a gain");
  const auto n = static_cast<double>(e.size() - order);
  const double chi = chi_squared_quantile(confidence, 1.0);
  const auto response = [&](const TransferFunction& each) -> Eigen::VectorXd {
    return channel_response(each, sample_time, input).tail(e.size());
  };
  const Eigen::VectorXd of_model = e + response(channel);
  std::vector<ProfiledMismatch> found;
  for (const MismatchFamily& family : mismatch_families(channel, sample_time)) {
    const MismatchObjective V = [&](double x) {
      return noise_squares(of_model - response(family.channel(x)), order);
    };
    const double best = grid_minimiser(V, family.grid);
    const double least = V(best);
    const double level = least * std::exp(chi / n);
    const double step = 0.01 * (family.grid.last - family.grid.first);
    found.push_back({family.parameter, family.value(best),
                     family.value(level_crossing(V, best, family.grid.first, step, level)),
                     family.value(level_crossing(V, best, family.grid.last, step, level)), least,
                     bound_within(best, family.grid.first, family.grid.last, 1e-3)});
  }
  std::stable_sort(found.begin(), found.end(), [](const ProfiledMismatch& a, const ProfiledMismatch& b) {
    return a.residual_sum < b.residual_sum;
  });
  return found;
}

}  // namespace mpm
