#pragma once

#include <vector>

#include "plants/linear/transfer_matrix.hpp"

namespace mpm::samples {

inline Eigen::VectorXd polynomial(std::initializer_list<double> coefficients) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(coefficients.size()));
  Eigen::Index i = 0;
  for (const double coefficient : coefficients) {
    result(i++) = coefficient;
  }
  return result;
}

/// One channel of every kind that the code treats differently, with whole and fractional dead times for Ts
/// = 2.
inline std::vector<TransferFunction> every_kind() {
  return {
      TransferFunction::first_order(3, 7, 0),
      TransferFunction::first_order(-2, 11, 4),
      TransferFunction::first_order(1.5, 5, 3.3),
      {polynomial({2.5}), polynomial({1}), 5},                           // gain and dead time
      {polynomial({2, 1}), polynomial({5, 1}), 1.7},                     // biproper
      {polynomial({4}), polynomial({36, 12, 1}), 0.9},                   // repeated pole
      {polynomial({1}), polynomial({25, 2, 1}), 6},                      // complex poles
      {polynomial({-6, 2}), polynomial({50, 15, 1}), 2.1},               // right-half-plane zero
      {polynomial({1, 0.3, 1}), polynomial({3, 4, 1}), 0},               // biproper, second order
      {polynomial({1, 2}), polynomial({8, 12, 6, 1}), 7.4},              // third order
      {polynomial({-1, 3, 1, 2}), polynomial({16, 32, 24, 8, 1}), 0.2},  // fourth order
      {polynomial({1, 0, 0, 2}), polynomial({27, 27, 9, 1}), 2},         // biproper, third order
  };
}

/// Every kind above in a 4 x 4 matrix with zero channels between them.
inline TransferMatrix mixed_matrix() {
  TransferMatrix G(4, 4);
  const std::vector<TransferFunction> kinds = every_kind();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const auto place = static_cast<Eigen::Index>((7 * i + 3) % 16);  // 7 and 16 are coprime: no place twice
    G(place / 4, place % 4) = kinds[i];
  }
  return G;
}

/// An input without structure, the same in every run: values in [-1, 1].
inline Eigen::MatrixXd rough_input(Eigen::Index rows, Eigen::Index cols) {
  Eigen::MatrixXd input(rows, cols);
  unsigned state = 12345;
  for (Eigen::Index k = 0; k < cols; ++k) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      state = 1664525U * state + 1013904223U;
      input(i, k) = static_cast<double>(state >> 8U) / 8388608.0 - 1.0;
    }
  }
  return input;
}

}  // namespace mpm::samples
