#pragma once

#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/lag_sums.hpp"
#include "analysis/identification/lane_cholesky.hpp"
#include "analysis/identification/output_error_errors.hpp"
#include "analysis/identification/signal_bank.hpp"

namespace mpm {

/// First guesses for `search_output_error`, by the steps 1 to 3 of `prediction_error_starts`, for one output
/// and several orders, which share the long ARX models. Products of shifted signals take the place of a
/// factorisation of the regressors, except where the regressors are so nearly dependent that the products
/// have too few digits.
class OutputErrorStarts {
 public:
  /// `errors` are those of models of y from u and must outlive the object. `rows` is the largest number of
  /// rows that the polynomials need. Every F has its roots within `largest_radius`.
  OutputErrorStarts(const Eigen::Ref<const Eigen::MatrixXd>& u, const Eigen::Ref<const Eigen::VectorXd>& y,
                    Eigen::Index delay, Eigen::Index rows, double largest_radius, OutputErrors& errors);

  /// The start with the smallest loss for nb coefficients of B and F of order nf; B = 0 and F = 1 if no loss
  /// is finite.
  OutputErrorCoefficients best(Eigen::Index nb, Eigen::Index nf);

 private:
  using ArxOrder = std::pair<Eigen::Index, Eigen::Index>;  ///< na, nb

  /// The response to each input alone by an ARX model, w_j = B_j/A u_j, and the inputs: each group of eight
  /// has four responses and then their inputs.
  const SignalBank& responses(const ArxOrder& order);
  OutputErrorCoefficients reduced(const SignalBank& responses, Eigen::Index nb, Eigen::Index nf);
  void fit_numerators(OutputErrorCoefficients& model);
  Eigen::VectorXd regression(const SignalBank& signals, const std::vector<LaggedColumns>& columns,
                             Eigen::Index target, Eigen::Index first);

  Eigen::Index nu_, delay_;
  double largest_radius_;
  OutputErrors& errors_;
  SignalBank signals_;  ///< the inputs and the output
  SignalBank inputs_;   ///< the inputs, in the places of the responses and in their own
  std::map<ArxOrder, SignalBank> responses_;
  // Signals that are filtered again and again. To allocate their memory each time would cost as much as a
  // filter.
  SignalBank filtered_signals_, filtered_, path_;
  LagSums sums_;
  LaneCholesky factor_;
};

}  // namespace mpm
