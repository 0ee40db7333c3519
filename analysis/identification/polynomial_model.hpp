#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/identification/model_order.hpp"
#include "analysis/statistics/discrete_filter.hpp"

namespace mpm {

/// The path from one input to the output, q^-delay B/F.
struct InputPath {
  Eigen::VectorXd B = Eigen::VectorXd::Zero(1);  ///< b_0, b_1, ...; nb coefficients
  Eigen::VectorXd F = Eigen::VectorXd::Ones(1);  ///< 1, f_1, ...; nf + 1 coefficients
  Eigen::Index delay = 1;                        ///< samples, 0 or more
};

/// A discrete-time model of one output and several inputs, deviations from the operating point,
///
///   A y = sum_j q^-delay_j (B_j/F_j) u_j + (C/D) e
///
/// with polynomials in q^-1 and a white e. Three families are special cases of it (Ljung 1999, chapter 4):
///
/// | family             | equation                            | equal to 1      |
/// |--------------------|-------------------------------------|-----------------|
/// | ARX                | A y = sum_j B_j u_j + e             | F, C, D         |
/// | output error (OE)  | y = sum_j B_j/F_j u_j + e           | A, C, D         |
/// | Box-Jenkins (BJ)   | y = sum_j B_j/F_j u_j + C/D e       | A               |
///
/// | symbol | meaning                      | shape  | unit     |
/// |--------|------------------------------|--------|----------|
/// | y, e   | output, innovations          | N      | of the CV |
/// | u      | inputs                       | nu x N | any      |
struct PolynomialModel {
  Eigen::VectorXd A = Eigen::VectorXd::Ones(1);
  std::vector<InputPath> inputs;
  Eigen::VectorXd C = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd D = Eigen::VectorXd::Ones(1);
  double noise_variance = 0.0;  ///< of e

  /// The orders of the polynomials.
  ModelOrder order() const;
  /// The free coefficients: a_1 ..., then b_0 ..., f_1 ... of each input in turn, c_1 ..., d_1 ...
  Eigen::VectorXd parameters() const;
  /// @throws InputError for a coefficient that is not finite, A, F, C or D that do not begin with 1, an empty
  ///   polynomial or a delay below 0
  void validate() const;
};

/// The model of these orders with the coefficients of `PolynomialModel::parameters`.
/// @throws InputError when their number is wrong, or the orders are
PolynomialModel model_from_parameters(const ModelOrder& order,
                                      const Eigen::Ref<const Eigen::VectorXd>& parameters);

/// Output without noise, sum_j B_j/(A F_j) u_j. Before the first sample every signal is as `start` says; with
/// `held` the model stands still at the first inputs.
/// @throws InputError for an invalid model, other than nu rows or values that are not finite
Eigen::VectorXd simulate(const PolynomialModel& model, const Eigen::Ref<const Eigen::MatrixXd>& u,
                         StartState start = StartState::rest);

/// The errors e = y - y_hat of the one-step-ahead prediction from past outputs, and from inputs up to the
/// delay,
///
///   e = (D/C) (A y - sum_j B_j/F_j u_j)
///
/// (Ljung 1999, eq. 3.20). What was before the record is as `start` says; a wrong assumption decays with the
/// roots of C and F.
/// @throws InputError for an invalid model, other than nu rows, different lengths or values that are not
/// finite
Eigen::VectorXd prediction_errors(const PolynomialModel& model, const Eigen::Ref<const Eigen::VectorXd>& y,
                                  const Eigen::Ref<const Eigen::MatrixXd>& u,
                                  StartState start = StartState::rest);

/// Response to a unit step in each input alone, nu x samples; column l-1 holds the outputs l samples after
/// the step, the layout of `NominalSensitivity::step_response`.
/// @throws InputError for an invalid model or fewer than 1 sample
Eigen::MatrixXd step_response(const PolynomialModel& model, Eigen::Index samples);

}  // namespace mpm
