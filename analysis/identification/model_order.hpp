#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace mpm {

/// Orders of the path from one input to the output, q^-delay B/F with B = b_0 + ... + b_(nb-1) q^-(nb-1) and
/// F = 1 + f_1 q^-1 + ... + f_nf q^-nf.
struct PathOrder {
  Eigen::Index nb = 1;     ///< coefficients of B, 1 or more
  Eigen::Index nf = 0;     ///< order of F
  Eigen::Index delay = 1;  ///< samples from the input to its first effect; 0 is a direct effect

  friend bool operator==(const PathOrder&, const PathOrder&) = default;
};

/// Orders of a polynomial model of one output (analysis/identification/polynomial_model.hpp).
struct ModelOrder {
  Eigen::Index na = 0;            ///< order of A
  std::vector<PathOrder> inputs;  ///< one path per input
  Eigen::Index nc = 0;            ///< order of C
  Eigen::Index nd = 0;            ///< order of D

  /// Number of free coefficients.
  Eigen::Index parameter_count() const;
  /// The earliest sample at which an ARX regression needs nothing from before the record.
  Eigen::Index memory() const;
  /// Every polynomial in one line, for tables: "nb 2 nf 2 nc 1 nd 1 delay 1", a list in brackets where the
  /// inputs differ.
  std::string to_string() const;
  /// @throws InputError unless there are `nu` inputs, every nb is 1 or more, and nothing else is below 0
  void validate(Eigen::Index nu) const;

  friend bool operator==(const ModelOrder&, const ModelOrder&) = default;
};

/// y = sum_j q^-delay B_j/F_j u_j + e, the same nb, nf and delay for `nu` inputs.
ModelOrder output_error_order(Eigen::Index nu, Eigen::Index nb, Eigen::Index nf, Eigen::Index delay = 1);

/// y = sum_j q^-delay B_j/F_j u_j + C/D e, the same nb, nf and delay for `nu` inputs.
ModelOrder box_jenkins_order(Eigen::Index nu, Eigen::Index nb, Eigen::Index nf, Eigen::Index nc,
                             Eigen::Index nd, Eigen::Index delay = 1);

}  // namespace mpm
