#pragma once

#include <Eigen/Core>

#include "analysis/identification/least_squares.hpp"
#include "analysis/statistics/discrete_filter.hpp"

namespace mpm {

/// Options of `identify_prediction_error`.
struct PredictionErrorOptions {
  /// The signals before the start of the record.
  StartState start = StartState::rest;
  /// The first sample whose prediction error counts. A later one lets the error of a wrong `start` decay.
  Eigen::Index first_sample = 0;
  /// Iterations of the search from one start.
  int max_iterations = 200;
  /// How many of `prediction_error_starts` are searched from, the best first, while none has led to a
  /// minimum.
  int max_starts = 3;
  /// Largest magnitude of the roots of C, D and F. A step of the search that leaves it is refused and taken
  /// shorter; a start outside is brought in by reflection (`stabilised`).
  double largest_radius = 0.9999;
  /// Smallest share of the largest diagonal element that counts as a direction (`least_squares`).
  double rank_tolerance = kRankTolerance;

  /// @throws InputError for a first sample below 0, an iteration limit or number of starts below 1, or a
  ///   radius or tolerance outside (0, 1)
  void validate() const;
  bool operator==(const PredictionErrorOptions&) const = default;
};

}  // namespace mpm
