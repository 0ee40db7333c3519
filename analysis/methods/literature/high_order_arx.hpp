#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/order_selection.hpp"

namespace mpm {

/// The CVs whose past outputs explain a CV in a high-order ARX model.
enum class ArxOutputs : std::int8_t {
  all = 0,  ///< AO_i is a full matrix, as in (2.1): what other CVs tell about the next sample counts as
            ///< predictable
  own = 1,  ///< AO_i is diagonal: ny times fewer coefficients, which a short record may require
};

/// Options of `identify_high_order_arx`.
struct HighOrderArxOptions {
  ArxOutputs outputs = ArxOutputs::all;
  /// The candidates for MO1 of (2.1); a single candidate is a fixed order.
  std::vector<Eigen::Index> orders{20};
  /// MO2 of (2.1); none: the same as MO1.
  std::optional<Eigen::Index> input_order;
  /// How one of several orders is chosen, separately for each CV. %Fit, which judges a simulation, is
  /// refused.
  OrderCriterion criterion = OrderCriterion::aic;
  /// The share of the record, at its end, that `validation_loss` keeps for validation.
  double validation_share = 0.3;
  /// Adds a constant to the terms of (2.1), for records that do not vary about 0.
  bool constant = true;
  /// The tolerance of `NestedLeastSquares`.
  double rank_tolerance = kRankTolerance;

  /// @throws InputError for an empty list, an order below 1, validation_fit, or a share or tolerance outside
  ///   (0, 1)
  void validate() const;
};

/// The length of the shortest record of `ny` CVs and `nr` references that has more samples than each
/// candidate has coefficients.
Eigen::Index fewest_samples(const HighOrderArxOptions& options, Eigen::Index ny, Eigen::Index nr);

/// The residuals of a high-order ARX model on a record of `ny` CVs and `N` samples.
///
/// | symbol | member      | shape  | meaning                                             |
/// |--------|-------------|--------|-----------------------------------------------------|
/// | e^d    | e_d         | ny x n | estimated disturbance innovations, unit of the CV   |
/// | MO1    | orders      | ny     | of each CV                                          |
/// | p      | parameters  | ny     | independent coefficients of each CV                 |
/// |        | first_sample |       | sample of the first column, n = N - first_sample    |
struct HighOrderArx {
  Eigen::MatrixXd e_d;
  std::vector<Eigen::Index> orders;
  std::vector<Eigen::Index> parameters;
  Eigen::Index first_sample = 0;
};

/// The disturbance innovations of a closed loop as the residuals of an ARX model between its references and
/// its outputs (2.1), (4.1), (A1.1),
///
///   y(k) = sum_{i=1}^{MO1} AO_i y(k-i) + sum_{i=1}^{MO2} BO_i r(k-i) + e^d(k)
///
/// by least squares, CV by CV. References and outputs suffice because the innovations do not depend on the
/// controller (feedback invariance).
///
/// | symbol | meaning                                              | shape  |
/// |--------|------------------------------------------------------|--------|
/// | y      | measured CVs                                         | ny x N |
/// | r      | setpoints, and other signals that act from outside; may have no row | nr x N |
///
/// All candidates are fitted to the same samples, k = max(MO1, MO2) ... N-1 of the largest candidate.
/// Coefficients that the record does not determine (of a reference that stands still) are left out: the
/// residuals do not depend on them. The residuals are a moving average of the record, so the model need not
/// be stable.
/// @throws InputError for different lengths, values that are not finite, no more samples than coefficients,
///   or invalid options
HighOrderArx identify_high_order_arx(const Eigen::Ref<const Eigen::MatrixXd>& y,
                                     const Eigen::Ref<const Eigen::MatrixXd>& r,
                                     const HighOrderArxOptions& options = {});

}  // namespace mpm
