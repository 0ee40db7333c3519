#include "analysis/statistics/discrete_filter.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <fmt/format.h>
#include <unsupported/Eigen/Polynomials>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_monic(const Eigen::Ref<const Eigen::VectorXd>& a) {
  if (a.size() == 0)
    throw InputError("monic polynomial", "no coefficient", "1 or more");
  if (a(0) != 1.0)
    throw InputError("first coefficient of a monic polynomial", fmt::format("{}", a(0)), "1");
  if (!a.allFinite())
    throw InputError("monic polynomial", "a coefficient that is not finite", "finite coefficients");
}

/// Returns the roots in z, which are the roots of z^n + a_1 z^(n-1) + ... + a_n.
Eigen::VectorXcd roots(const Eigen::Ref<const Eigen::VectorXd>& a) {
  if (a.size() == 1)
    return {};
  const Eigen::VectorXd ascending = a.reverse();
  return Eigen::PolynomialSolver<double, Eigen::Dynamic>(ascending).roots();
}

/// Filters without a delay; input and output are 0 before the first sample.
Eigen::VectorXd filter_from_rest(const Eigen::Ref<const Eigen::VectorXd>& b,
                                 const Eigen::Ref<const Eigen::VectorXd>& a, const Eigen::VectorXd& x) {
  const Eigen::Index N = x.size();
  Eigen::VectorXd y = b(0) * x;
  for (Eigen::Index i = 1; i < std::min(b.size(), N); ++i)
    y.tail(N - i) += b(i) * x.head(N - i);
  if (a.size() == 1)
    return y;
  for (Eigen::Index k = 1; k < N; ++k) {
    double fed_back = 0.0;
    for (Eigen::Index i = std::min(a.size() - 1, k); i > 0; --i)
      fed_back += a(i) * y(k - i);
    y(k) -= fed_back;
  }
  return y;
}

double steady_output(const Eigen::Ref<const Eigen::VectorXd>& b, const Eigen::Ref<const Eigen::VectorXd>& a,
                     double x) {
  if (x == 0.0)
    return 0.0;
  if (a.sum() == 0.0)
    throw InputError("steady state of a filter", "a denominator with a root at 1",
                     "none, or a start from rest");
  return x * b.sum() / a.sum();
}

}  // namespace

Eigen::VectorXd delayed(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index delay, StartState start) {
  if (delay < 0)
    throw InputError("delay", fmt::format("{} samples", delay), "0 or more");
  const Eigen::Index N = x.size();
  const Eigen::Index before = std::min(delay, N);
  const double value = start == StartState::held && N > 0 ? x(0) : 0.0;
  Eigen::VectorXd y(N);
  y.head(before).setConstant(value);
  y.tail(N - before) = x.head(N - before);
  return y;
}

Eigen::VectorXd filter(const Eigen::Ref<const Eigen::VectorXd>& b, const Eigen::Ref<const Eigen::VectorXd>& a,
                       const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Index delay, StartState start) {
  require_monic(a);
  if (b.size() == 0)
    throw InputError("numerator of a filter", "no coefficient", "1 or more");
  Eigen::VectorXd input = delayed(x, delay, start);
  if (start == StartState::rest || x.size() == 0)
    return filter_from_rest(b, a, input);
  // The filter is linear, so that the deviation from the steady state starts from rest.
  const double steady = steady_output(b, a, x(0));
  input.array() -= x(0);
  return filter_from_rest(b, a, input).array() + steady;
}

double root_radius(const Eigen::Ref<const Eigen::VectorXd>& a) {
  require_monic(a);
  return a.size() == 1 ? 0.0 : roots(a).cwiseAbs().maxCoeff();
}

bool has_roots_within(const Eigen::Ref<const Eigen::VectorXd>& a, double radius) {
  if (!a.allFinite())
    return false;
  require_monic(a);
  Eigen::VectorXd scaled = a;  // its roots are those of a divided by `radius`
  double power = 1.0;
  for (double& coefficient : scaled) {
    coefficient *= power;
    power /= radius;
  }
  for (Eigen::Index degree = a.size() - 1; degree > 0; --degree) {
    const double reflection = scaled(degree);
    if (!(std::abs(reflection) < 1.0))
      return false;
    const double share = 1.0 - reflection * reflection;
    for (Eigen::Index i = 0, j = degree; i <= j; ++i, --j) {  // subtracts the mirror image of the polynomial
      const double low = scaled(i), high = scaled(j);
      scaled(i) = (low - reflection * high) / share;
      scaled(j) = (high - reflection * low) / share;
    }
  }
  return true;
}

Eigen::VectorXd stabilised(const Eigen::Ref<const Eigen::VectorXd>& a, double radius) {
  require_monic(a);
  if (!(radius > 0.0 && radius <= 1.0))
    throw InputError("radius of the roots", fmt::format("{}", radius), "above 0, up to 1");
  if (has_roots_within(a, radius))
    return a;
  Eigen::VectorXcd z = roots(a);
  if (z.cwiseAbs().maxCoeff() <= radius)
    return a;
  for (std::complex<double>& root : z) {
    if (std::abs(root) > 1.0)
      root = 1.0 / std::conj(root);
    if (std::abs(root) > radius)
      root *= radius / std::abs(root);
  }
  Eigen::VectorXcd ascending(a.size());
  Eigen::roots_to_monicPolynomial(z, ascending);
  return ascending.real().reverse();
}

}  // namespace mpm
