#pragma once

#include "analysis/basis/basis_case.hpp"

namespace mpm {

/// Fills `healthy` and `explanation` of a basis case that has all else. In this order: the loop ran to its
/// end; T0 has settled at the end of its step responses, and at 1 for a CV at its reference, unless there are
/// more references than free MVs; some CV moves; and the index of `study.diagnosis.self_check` lies in its
/// band for every CV. A study that asks for no self-check passes once its loop ran.
void check_basis(const Study& study, const QpSolverFactory& factory, BasisCase& basis);

}  // namespace mpm
