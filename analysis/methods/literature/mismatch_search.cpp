#include "analysis/methods/literature/mismatch_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mpm {
namespace {

constexpr int kGoldenSteps = 16;        ///< reduces two intervals of the grid to 1/2000
constexpr int kIntervalHalvings = 12;   ///< halvings for each end of an interval
constexpr double kLargestShift = 10.0;  ///< samples

}  // namespace

std::vector<MismatchFamily> mismatch_families(const TransferFunction& channel, double sample_time) {
  const auto same = [](double x) { return x; };
  const auto power = [](double x) { return std::exp2(x); };
  std::vector<MismatchFamily> families;
  families.push_back({MismatchParameter::gain,
                      {-2.0, 4.0, 13},
                      [&channel](double x) { return channel.with_gain_scaled(x); },
                      same});
  if (channel.has_time_constant())
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

double grid_minimiser(const MismatchObjective& objective, const SearchGrid& grid) {
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

double level_crossing(const MismatchObjective& objective, double inside, double end, double step,
                      double level) {
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
  for (int i = 0; i < kIntervalHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (objective(middle) <= level ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

}  // namespace mpm
