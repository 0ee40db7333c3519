#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/identification.hpp"
#include "analysis/identification/prediction_error_options.hpp"

namespace mpm {

/// Criterion that chooses one of several models.
enum class OrderCriterion : std::int8_t {
  validation_fit = 0,  ///< %Fit (3.32) of the simulated output on validation data: what the thesis reports,
                       ///< and what counts when the response to the inputs is wanted
  validation_loss =
      1,    ///< mean squared one-step prediction error on validation data: what counts for C and D
  aic = 2,  ///< n log V + 2 p on the estimation data (Akaike): no data need be kept for validation;
            ///< nearest to the best predictor among models that are all too small
  bic = 3,  ///< n log V + p log n (Schwarz): finds the true order, if it is among them, as n grows
};

/// Orders to be tried, all combinations; the same for every input. An empty list is refused.
struct OrderGrid {
  std::vector<Eigen::Index> na{0};
  std::vector<Eigen::Index> nb{2};
  std::vector<Eigen::Index> nf{0};
  std::vector<Eigen::Index> nc{0};
  std::vector<Eigen::Index> nd{0};
  std::vector<Eigen::Index> delay{1};
};

/// The combinations of a grid for `nu` inputs.
/// @throws InputError for an empty list or an order that is not allowed
std::vector<ModelOrder> order_candidates(const OrderGrid& grid, Eigen::Index nu);

/// Options of `select_order`.
struct OrderSelectionOptions {
  OrderCriterion criterion = OrderCriterion::validation_fit;
  /// Share of the record that is kept for validation, at its end. The model is run over the whole record and
  /// judged on the end, so that no initial state of the end has to be guessed.
  double validation_share = 0.3;
  /// A smaller model is preferred if its criterion is within this of the best: in percentage points of %Fit,
  /// relative for the loss, absolute for AIC and BIC.
  double tolerance = 1e-6;
  /// How each model is fitted. The first sample of the loss is moved to the largest `ModelOrder::memory` of
  /// all ARX candidates, so that all candidates have the same samples.
  PredictionErrorOptions fit;

  /// @throws InputError for a share outside (0, 1), a tolerance below 0 or invalid options of the fit
  void validate() const;
};

/// One model that was tried.
struct OrderCandidate {
  ModelOrder order;
  Identification identification;  ///< on the estimation data
  double validation_fit = 0.0;    ///< percent; NaN for a validation output without variance
  double validation_loss = 0.0;
  double aic = 0.0;
  double bic = 0.0;
};

/// The result of a selection.
struct OrderSelection {
  std::vector<OrderCandidate> candidates;  ///< in the order given
  std::optional<std::size_t> best;         ///< none if no candidate has a usable status and a criterion
};

/// Identifies a model of each order on the first part of a record and chooses one by the criterion. Models
/// without a usable status (`is_usable`) are never chosen.
/// @throws InputError for no candidate, invalid options, and as `identify` (a candidate with more parameters
///   than the estimation data have samples is an error, not an outcome)
OrderSelection select_order(const Eigen::Ref<const Eigen::VectorXd>& y,
                            const Eigen::Ref<const Eigen::MatrixXd>& u,
                            const std::vector<ModelOrder>& candidates,
                            const OrderSelectionOptions& options = {});

}  // namespace mpm
