#pragma once

#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "base/row.hpp"
#include "scenarios/loop/audit.hpp"

namespace mpm {

/// How hard the optimisation problems were, and how well they were solved.
std::vector<Row<SolverStatistics>> solver_rows();
/// What the audit of a step found.
std::vector<Row<AuditedStep>> audit_rows();
/// How a closed loop ended.
std::vector<Row<Trajectory>> loop_rows();
/// Everything that was recorded in a closed loop.
std::vector<Row<Trajectory>> signal_rows(const Study& study);
/// y_sim, y0 and y0_diag.
std::vector<Row<NominalOutputs>> nominal_rows(const Study& study);

/// A signal of this study: a matrix with one row for each "cv", "mv" or "md", and one column for each sample.
template <class Owner, class Lens>
Row<Owner> signal_row(const Study& study, NumberText text, const char* rows, Lens lens) {
  const std::string of = rows;
  const Eigen::Index count = of == "cv" ? study.cv_count() : of == "mv" ? study.mv_count() : study.md_count();
  return matrix_row<Owner>(std::move(text), {of, "sample"}, count, study.simulation.samples, lens);
}

}  // namespace mpm
