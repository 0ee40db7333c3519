#pragma once

#include <optional>

#include <Eigen/Core>

#include "analysis/identification/identification.hpp"
#include "analysis/identification/least_squares.hpp"
#include "analysis/identification/model_order.hpp"

namespace mpm {

/// Options of `identify_arx`.
struct ArxOptions {
  /// The first sample whose prediction error counts; none: `ModelOrder::memory`, the first one that needs no
  /// value from before the record. Models that are compared by their loss need the same first sample.
  std::optional<Eigen::Index> first_sample;
  /// Smallest share of the largest diagonal element that counts as a direction (`least_squares`).
  double rank_tolerance = kRankTolerance;

  /// @throws InputError for a tolerance outside (0, 1) or a first sample before `memory` of the order
  void validate(const ModelOrder& order) const;
};

/// The regressors of A y = sum_j q^-delay B_j u_j + e, rows `first` ... N-1:
///
///   y(k) = [-y(k-1) ... -y(k-na), u_j(k-delay_j) ... u_j(k-delay_j-nb_j+1), ...] theta + e(k)
///
/// `first` must be `order.memory()` or later.
Eigen::MatrixXd arx_regressors(const ModelOrder& order, const Eigen::Ref<const Eigen::VectorXd>& y,
                               const Eigen::Ref<const Eigen::MatrixXd>& u, Eigen::Index first);

/// Fits an ARX model of an output by linear least squares over the samples that need nothing from before the
/// record. For Gaussian e this is the maximum-likelihood estimate, given the samples before them. The same
/// function fits the high-order models of (4.1): the cost is 2 N p^2 operations for p parameters. Outputs of
/// other CVs may be inputs with a delay of 1.
///
/// | symbol | meaning | shape  |
/// |--------|---------|--------|
/// | y      | output  | N      |
/// | u      | inputs  | nu x N |
///
/// Rank-deficient data give the status rank_deficient and the coefficients of least norm, without a
/// covariance. The poles are as the data determine them, stable or not.
/// @throws InputError for an order with F, C or D, without a parameter, or for another number of inputs;
///   different lengths, values that are not finite, no more samples than parameters; invalid options
Identification identify_arx(const Eigen::Ref<const Eigen::VectorXd>& y,
                            const Eigen::Ref<const Eigen::MatrixXd>& u, const ModelOrder& order,
                            const ArxOptions& options = {});

}  // namespace mpm
