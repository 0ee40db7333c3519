#pragma once

#include "analysis/identification/output_error_errors.hpp"

namespace mpm {

/// The limits of a search.
struct OutputErrorSearch {
  int max_iterations;
  double largest_radius;  ///< of the roots of F
};

/// A model that a search has found.
struct OutputErrorMinimum {
  OutputErrorCoefficients model;
  double loss;  ///< sum of e^2; infinity if it is not finite
};

/// Minimises sum e^2 from `start` as `search_prediction_error` does, with the same steps of the
/// Levenberg-Marquardt method (Ceres's scaling, radius and tolerances) up to rounding. The steps follow from
/// the products J'J of the gradients instead of an orthogonal factorisation of J. All these products follow
/// from those of 1/F_j u_j and 1/F_j^2 B_j u_j by shifts (`LagSums`).
OutputErrorMinimum search_output_error(OutputErrors& errors, const OutputErrorCoefficients& start,
                                       const OutputErrorSearch& search);

}  // namespace mpm
