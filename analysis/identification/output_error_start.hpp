#pragma once

#include <map>
#include <utility>

#include "analysis/identification/output_error_search.hpp"

namespace mpm {

/// First guesses for `search_output_error`, by the steps 1 to 3 of `prediction_error_starts`, for one output
/// and several orders, which share the long ARX models. Products of shifted signals take the place of a
/// factorisation of the regressors, except where these are so near to dependent that the products would not
/// tell.
class OutputErrorStarts {
 public:
  /// `problem` must outlive the object.
  explicit OutputErrorStarts(const OutputErrorProblem& problem);

  /// The start with the smallest loss for nb coefficients of B and F of order nf; 0 when no loss is finite.
  OutputErrorCoefficients best(Eigen::Index nb, Eigen::Index nf);

 private:
  using ArxOrder = std::pair<Eigen::Index, Eigen::Index>;  ///< na, nb

  /// What each input alone does by an ARX model, w_j = B_j/A u_j, and behind them the inputs.
  const SignalBank& responses(const ArxOrder& order);
  OutputErrorCoefficients reduced(const SignalBank& responses, Eigen::Index nb, Eigen::Index nf) const;
  void fit_numerators(OutputErrorCoefficients& model) const;

  const OutputErrorProblem& problem_;
  std::map<ArxOrder, SignalBank> responses_;
};

}  // namespace mpm
