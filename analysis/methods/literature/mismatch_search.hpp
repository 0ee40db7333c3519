#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/transfer_function.hpp"
#include "scenarios/faults/fault.hpp"

// How methods search for the one wrong parameter of a channel.

namespace mpm {

using MismatchObjective = std::function<double(double)>;

/// The range and the points of the search for a parameter.
struct SearchGrid {
  double first, last;
  Eigen::Index points;

  double at(Eigen::Index i) const {
    return first + (last - first) * static_cast<double>(i) / static_cast<double>(points - 1);
  }
};

/// A channel in which one parameter is searched, in a coordinate x in which equal steps have similar effects:
/// the logarithm for a time constant.
struct MismatchFamily {
  MismatchParameter parameter;
  SearchGrid grid;
  std::function<TransferFunction(double)> channel;
  std::function<double(double)> value;
};

/// The families of gain, time constant and dead time, as far as the channel has them: gains from -2 to 4
/// times that of the model, time constants from 1/8 to 8 times, dead times up to 10 samples to either side.
/// `channel` must outlive them.
std::vector<MismatchFamily> mismatch_families(const TransferFunction& channel, double sample_time);

/// The point of the least value on the grid, refined between its neighbours by golden section.
double grid_minimiser(const MismatchObjective& objective, const SearchGrid& grid);

/// The point at which the objective crosses `level` between `inside`, where it is below, and the end of the
/// search.
double level_crossing(const MismatchObjective& objective, double inside, double end, double step,
                      double level);

}  // namespace mpm
