#include "analysis/methods/mismatch_profile.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Cholesky>
#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

#include "analysis/methods/channel_regressors.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

using Objective = std::function<double(double)>;

/// Where a parameter is searched.
struct SearchGrid {
  double first, last;
  Eigen::Index points;

  double at(Eigen::Index i) const {
    return first + (last - first) * static_cast<double>(i) / static_cast<double>(points - 1);
  }
};

constexpr int kGoldenSteps = 16;        ///< to 1/2000 of two intervals of the grid
constexpr int kHalvings = 12;           ///< of the ends of an interval
constexpr double kLargestShift = 10.0;  ///< samples

/// V(v) of what is left of e: the last Cholesky pivot of the products of the constant, its past and itself is
/// the part of e that the others do not explain.
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

/// The least value on the grid, refined between its neighbours.
double minimiser(const Objective& objective, const SearchGrid& grid) {
  Eigen::Index best = 0;
  double least = objective(grid.at(0));
  for (Eigen::Index i = 1; i < grid.points; ++i) {
    const double value = objective(grid.at(i));
    if (value < least) {
      least = value;
      best = i;
    }
  }
  double lower = grid.at(std::max<Eigen::Index>(0, best - 1));
  double upper = grid.at(std::min(grid.points - 1, best + 1));
  constexpr double kShare = std::numbers::phi - 1.0;
  double a = upper - kShare * (upper - lower), b = lower + kShare * (upper - lower);
  double at_a = objective(a), at_b = objective(b);
  for (int step = 0; step < kGoldenSteps; ++step) {
    if (at_a < at_b) {
      upper = b;
      b = a;
      at_b = at_a;
      a = upper - kShare * (upper - lower);
      at_a = objective(a);
    } else {
      lower = a;
      a = b;
      at_a = at_b;
      b = lower + kShare * (upper - lower);
      at_b = objective(b);
    }
  }
  const double found = at_a < at_b ? a : b;
  return std::min(at_a, at_b) < least ? found : grid.at(best);
}

/// Where the objective crosses `level` between `inside`, where it is below, and the end of the search.
double crossing(const Objective& objective, double inside, double end, double step, double level) {
  double outside = inside;
  const double direction = end > inside ? 1.0 : -1.0;
  do {
    inside = outside;
    if (inside == end)
      return end;
    outside = inside + direction * step;
    if ((outside - end) * direction > 0.0)
      outside = end;
    step *= 2.0;
  } while (objective(outside) <= level);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (objective(middle) <= level ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

/// A channel in which one parameter is searched, in a coordinate x in which steps are alike: the time
/// constant by its logarithm.
struct Family {
  MismatchParameter parameter;
  SearchGrid grid;
  std::function<TransferFunction(double)> channel;
  std::function<double(double)> value;
};

std::vector<Family> families_of(const TransferFunction& channel, double sample_time) {
  const auto same = [](double x) { return x; };
  const auto power = [](double x) { return std::exp2(x); };
  std::vector<Family> families;
  families.push_back({MismatchParameter::gain,
                      {-2.0, 4.0, 13},
                      [&channel](double x) { return channel.with_gain_scaled(x); },
                      same});
  if (!channel.is_integrating() && channel.order() > 0)
    families.push_back({MismatchParameter::time_constant,
                        {-3.0, 3.0, 13},
                        [&channel, power](double x) { return channel.with_time_scaled(power(x)); },
                        power});
  const double earliest = -std::min(channel.dead_time(), kLargestShift * sample_time);
  const double latest = kLargestShift * sample_time;
  families.push_back({MismatchParameter::dead_time,
                      {earliest, latest, 2 + static_cast<Eigen::Index>((latest - earliest) / sample_time)},
                      [&channel](double x) { return channel.with_dead_time_shifted(x); },
                      same});
  return families;
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
  const double chi = boost::math::quantile(boost::math::chi_squared_distribution<>(1.0), confidence);
  const auto response = [&](const TransferFunction& each) -> Eigen::VectorXd {
    return channel_response(each, sample_time, input).tail(e.size());
  };
  const Eigen::VectorXd of_model = e + response(channel);
  std::vector<ProfiledMismatch> found;
  for (const Family& family : families_of(channel, sample_time)) {
    const Objective V = [&](double x) {
      return noise_squares(of_model - response(family.channel(x)), order);
    };
    const double best = minimiser(V, family.grid);
    const double least = V(best);
    const double level = least * std::exp(chi / n);
    const double step = 0.01 * (family.grid.last - family.grid.first);
    found.push_back({family.parameter, family.value(best),
                     family.value(crossing(V, best, family.grid.first, step, level)),
                     family.value(crossing(V, best, family.grid.last, step, level)), least});
  }
  std::stable_sort(found.begin(), found.end(), [](const ProfiledMismatch& a, const ProfiledMismatch& b) {
    return a.residual_sum < b.residual_sum;
  });
  return found;
}

}  // namespace mpm
