#pragma once

#include "analysis/basis/basis_case.hpp"

namespace mpm {

/// Fills `healthy` and `explanation` of a basis case that has all else. Checks in this order that the loop
/// ran to its end; that T0 has settled at the end of its step responses, at 1 for a CV and its own reference
/// unless there are more references than free MVs; that some CV moves; and that the index of
/// `study.diagnosis.self_check` lies in its band for every CV. A study that asks for no self-check passes if
/// its loop ran to its end.
void check_basis(const Study& study, const QpSolverFactory& factory, BasisCase& basis);

}  // namespace mpm
