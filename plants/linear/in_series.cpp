#include "plants/linear/in_series.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/linear/settling_time.hpp"
#include "plants/linear/step_coefficients.hpp"
#include "plants/linear/transfer_matrix.hpp"
#include "plants/linear/zero_order_hold.hpp"

namespace mpm {
namespace {

/// Returns the response of H(s), which has no coefficients, to S(t): exact at multiples of T, and long enough
/// for H to settle. S' is constant between coefficients, so that H S' / s is the response of H / s to a held
/// input.
StepCoefficients response(const TransferFunction& H, const StepCoefficients& S) {
  const double T = S.interval();
  const Eigen::VectorXd values = S.sampled(T);
  const Eigen::Index n = values.size();
  const double settled = H.dead_time() + kTimesToSettle * sum_of_time_constants(H);
  if (!(S.end() + settled <= kMaxDelay * T))
    throw InputError("coefficients of a step response behind a further lag",
                     fmt::format("{:.3g}", (S.end() + settled) / T), fmt::format("at most {}", kMaxDelay));
  const Eigen::Index count = n + static_cast<Eigen::Index>(std::ceil(settled / T));
  Eigen::RowVectorXd slopes = Eigen::RowVectorXd::Constant(count + 1, S.rate());
  slopes.head(n) = values.transpose() / T;
  slopes.segment(1, n - 1) -= values.head(n - 1).transpose() / T;
  Eigen::VectorXd over_s = Eigen::VectorXd::Zero(H.denominator().size() + 1);
  over_s.head(H.denominator().size()) = H.denominator();
  const TransferMatrix integrated{{TransferFunction(H.numerator(), over_s, H.dead_time())}};
  return {simulate(integrated, T, slopes).row(0).tail(count).transpose(), T, S.ramps() || H.is_integrating()};
}

}  // namespace

TransferFunction in_series(const TransferFunction& first, const TransferFunction& second) {
  const TransferFunction G = first.without_washout(), H = second.without_washout();
  TransferFunction both(polynomial_product(G.numerator(), H.numerator()),
                        polynomial_product(G.denominator(), H.denominator()), G.dead_time() + H.dead_time());
  if (const auto& S = H.step_coefficients())
    both = both.with_step_coefficients(response(G.without_step_coefficients(), *S));
  else if (const auto& S_of_first = G.step_coefficients())
    both = both.with_step_coefficients(response(H, *S_of_first));
  const double washout = second.washout() > 0 ? second.washout() : first.washout();
  return washout > 0 ? both.behind_washout(washout) : both;
}

}  // namespace mpm
