#pragma once

#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "analysis/sensitivity/second_order_fit.hpp"

namespace mpm {

/// The diagonal element of T0 of one CV in two control structures: with all MVs that the operating point
/// leaves free, and with those of `s0_perturbation.fixed_mvs` held (figures 6.30 to 6.32).
struct StructureFit {
  Eigen::Index cv;
  SecondOrderFit available;         ///< (6.24) with the MVs available
  SecondOrderFit fixed;             ///< (6.24) with them held
  double time_constant_multiplier;  ///< tau of `fixed` over that of `available`; NaN without both fits
  double damping_multiplier;        ///< the same for xi
};

/// The fits of all CVs at an active limit in both structures, in the order of the second; none if the study
/// has no second structure. The multipliers replace those of S0Perturbation: Ivar_diag tolerates a change of
/// structure if it tolerates these.
std::vector<StructureFit> structure_fits(const Study& study, const BasisCase& basis);

}  // namespace mpm
