#pragma once

#include <complex>
#include <initializer_list>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/transfer_function.hpp"

namespace mpm {

/// A matrix G(s) of transfer functions with dead times: one row per output, one column per input,
///
///   y_i(s) = sum_j G_ij(s) u_j(s).
class TransferMatrix {
 public:
  /// The 0 x 0 matrix.
  TransferMatrix() = default;

  /// `rows` x `cols` channels without effect. Errors: InputError for a negative size.
  TransferMatrix(Eigen::Index rows, Eigen::Index cols);

  /// One inner list per output, as the matrix is printed. Errors: InputError for rows of unequal length.
  TransferMatrix(std::initializer_list<std::initializer_list<TransferFunction>> rows);

  Eigen::Index rows() const { return rows_; }
  Eigen::Index cols() const { return cols_; }

  /// The channel from input `col` to output `row`. Errors: InputError for an index outside the matrix.
  const TransferFunction& operator()(Eigen::Index row, Eigen::Index col) const;
  TransferFunction& operator()(Eigen::Index row, Eigen::Index col);

  /// G(0), rows() x cols(). Errors: InputError naming the first integrating channel.
  Eigen::MatrixXd static_gain() const;

  /// Whether a channel of the row has a pole at the origin, so that constant inputs hold the output only if
  /// its rate is 0.
  bool is_integrating(Eigen::Index row) const;
  /// Whether any row integrates.
  bool is_integrating() const;

  /// The final effect of a constant input of 1, rows() x cols(): on the output, G(0), or, in a row that
  /// integrates, on its rate, lim s G(s).
  Eigen::MatrixXd steady_gain() const;

  /// The outputs at which a plant rests under a constant `input` (cols()), rows(): G(0) input. An integrating
  /// channel adds 0, as in LinearPlant::reset().
  Eigen::VectorXd steady_output(const Eigen::Ref<const Eigen::VectorXd>& input) const;

  /// The same matrix with only the rational forms of channels that have step coefficients.
  TransferMatrix without_step_coefficients() const;

  /// G(s) at one complex s, rows() x cols().
  Eigen::MatrixXcd frequency_response(std::complex<double> s) const;

  friend bool operator==(const TransferMatrix&, const TransferMatrix&) = default;

 private:
  std::size_t position(Eigen::Index row, Eigen::Index col) const;

  Eigen::Index rows_ = 0;
  Eigen::Index cols_ = 0;
  std::vector<TransferFunction> channels_;  // row after row
};

}  // namespace mpm
