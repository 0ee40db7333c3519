#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/comparison.hpp"
#include "results/archive/variable_text.hpp"
#include "scenarios/audit.hpp"

namespace mpm {

/// How one number of an `Owner` is taken out and put back.
template <class Owner, class T>
struct Access {
  std::function<T(const Owner&)> get;
  std::function<void(Owner&, T)> set;
};

/// One number of an `Owner` as a variable of the archive: the one place that says what it is called, what it
/// means and where it is in memory.
template <class Owner>
struct Column {
  VariableText text;
  std::variant<Access<Owner, std::int8_t>, Access<Owner, std::int32_t>, Access<Owner, std::int64_t>,
               Access<Owner, double>, Access<Owner, std::string>>
      access;
};

/// A member of `Owner` with one number a CV.
template <class Owner>
struct CvColumn {
  VariableText text;
  Eigen::VectorXd Owner::*member;
};

/// A record of a closed loop, one row a variable: the dimension of its rows and where it is in memory.
struct SignalColumn {
  VariableText text;
  std::string rows;  ///< "cv", "mv" or "md"
  Eigen::MatrixXd Trajectory::*member;
};

/// What a verdict may say is wrong: none, mpm, ud, mpm_ud.
Flags kind_flags();

/// What an experiment does to the loop, and how it ended. `kind` comes first: it says which faults there are.
std::vector<Column<ExperimentRecord>> draw_columns(const Study& study);
/// The variance indices of the CVs.
std::vector<CvColumn<Diagnosis>> variance_columns();
/// The verdict and the indicators behind it.
std::vector<Column<Diagnosis>> verdict_columns(const Study& study);
/// What the chain says of every CV of a named scenario. A later indicator is one more line in this list.
std::vector<Column<CvDiagnosis>> cv_columns();
/// What the autocorrelation functions of a CV of the basis case say.
std::vector<Column<AcfComparison>> basis_acf_columns();
/// What the loops with one of two faults say.
std::vector<Column<ExperimentRecord>> dominance_columns();
/// How hard the optimisation problems were, and how well they were solved.
std::vector<Column<SolverStatistics>> solver_columns();
/// What the audit of a step found.
std::vector<Column<AuditedStep>> audit_columns();
/// What a method of assessment says of a loop, but for the channels.
std::vector<Column<MethodVerdict>> method_verdict_columns(const Study& study);
/// How a closed loop ended.
std::vector<Column<Trajectory>> loop_columns();
/// Everything that was recorded in a closed loop.
std::vector<SignalColumn> signal_columns(const Study& study);
/// How many rows the signal has in this study.
Eigen::Index row_count(const SignalColumn& signal, const Study& study);
/// y_sim, which is no member of a Trajectory.
VariableText y_sim_text(const Study& study);

}  // namespace mpm
