#include <algorithm>
#include <cstdint>
#include <utility>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/statistics/autocorrelation.hpp"
#include "base/non_finite.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/columns.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/matrix_io.hpp"

namespace mpm {
namespace {

constexpr const char* kBasisGroup = "basis";

using Nominal = std::pair<VariableText, Eigen::MatrixXd NominalOutputs::*>;

std::vector<Nominal> nominal_columns(const Study& study) {
  const std::string unit = common_unit(study.plant.cvs);
  return {{y_sim_text(study), &NominalOutputs::y_sim},
          {{"y0", "nominal output y + S0 (y_sim - y)", unit, "", {}, "time"}, &NominalOutputs::y0},
          {{"y0_diag", "nominal diagonal output y + S0_diag (y_sim - y)", unit, "", {}, "time"},
           &NominalOutputs::y0_diag}};
}

VariableText active_limit_text() {
  return {"active_limit",
          "soft limit or setpoint that the CV is held at",
          "1",
          "",
          {{-1, 0, 1, 2}, {"lower", "none", "upper", "setpoint"}}};
}

std::int8_t active_limit(ConstraintKind kind) {
  return kind == ConstraintKind::lower_limit ? std::int8_t{-1} : static_cast<std::int8_t>(kind);
}

VariableText fixed_mv_text() {
  return {"fixed_mv", "the MV is at a hard limit and not available for control", "1", "", yes_no_flags()};
}

VariableText u_point_text(const Study& study) {
  return {"u_operating", "MVs at the operating point", common_unit(study.plant.mvs)};
}

VariableText y_point_text(const Study& study) {
  return {"y_operating", "CVs at the operating point", common_unit(study.plant.cvs)};
}

void write_operating_point(Hdf5Group& group, const Study& study, const OperatingPoint& point) {
  write_vectors(group, {"mv"}, u_point_text(study), {&point.u}, study.mv_count());
  write_vectors(group, {"cv"}, y_point_text(study), {&point.y}, study.cv_count());
  std::vector<std::int8_t> limit(study.plant.cvs.size(), 0), fixed(study.plant.mvs.size(), 0);
  for (const auto& [cv, kind] : point.active)
    limit[static_cast<std::size_t>(cv)] = active_limit(kind);
  for (const Eigen::Index mv : point.fixed_mvs)
    fixed[static_cast<std::size_t>(mv)] = 1;
  group.write("active_limit", {"cv"}, limit, attributes<std::int8_t>(active_limit_text()));
  group.write("fixed_mv", {"mv"}, fixed, attributes<std::int8_t>(fixed_mv_text()));
}

OperatingPoint read_operating_point(const Hdf5Group& group, const Study& study) {
  OperatingPoint point;
  point.u = read_vectors(group, "u_operating", false, 1, study.mv_count()).front();
  point.y = read_vectors(group, "y_operating", false, 1, study.cv_count()).front();
  const std::vector<std::int8_t> fixed = group.read<std::int8_t>("fixed_mv", {study.plant.mvs.size()});
  for (std::size_t mv = 0; mv < fixed.size(); ++mv)
    if (fixed[mv] != 0)
      point.fixed_mvs.push_back(static_cast<Eigen::Index>(mv));
  return point;
}

/// Autocorrelation of each row; NaN for a row that has none.
Eigen::MatrixXd autocorrelations(const Eigen::MatrixXd& signal, Eigen::Index rows, Eigen::Index max_lag) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(rows, max_lag + 1, kNaN);
  for (Eigen::Index i = 0; i < signal.rows(); ++i)
    if (signal.row(i).allFinite())
      values.row(i) = autocorrelation(signal.row(i).transpose(), max_lag).values;
  return values;
}

/// For people: they follow from the signals and are not read back.
void write_autocorrelations(Hdf5Group& group, const Study& study, const BasisCase& basis) {
  const Eigen::Index max_lag = lag_count(study) - 1;
  write_sample_dimension(group, "lag", "lag in samples", "lag_time", study, 0, max_lag + 1);
  for (const auto& [of, signal] : {std::pair{"y", &basis.trajectory.y}, std::pair{"y0", &basis.nominal.y0},
                                   std::pair{"y0_diag", &basis.nominal.y0_diag}}) {
    const Eigen::MatrixXd values = autocorrelations(*signal, study.cv_count(), max_lag);
    write_matrices(group, {"cv", "lag"},
                   {std::string("acf_") + of,
                    std::string("autocorrelation of ") + of,
                    "1",
                    "NaN: the signal is constant, or not known",
                    {},
                    "lag_time"},
                   {&values}, study.cv_count(), max_lag + 1);
  }
}

/// What the chain says of the basis case, for the self-check: its numbers, without a verdict.
AssessmentRecord chain_assessment(const Study& study, std::vector<AssessmentNumber> numbers) {
  Assessment assessment;
  assessment.numbers = std::move(numbers);
  return kept(diagnosis_form(study), assessment);
}

}  // namespace

void write_basis(Hdf5Group& root, const Study& study, const BasisCase& basis) {
  Hdf5Group group = root.create_group(kBasisGroup);
  group.write_attribute("title", "Closed loop without mismatch and unmeasured disturbance");
  group.write_attribute("healthy", std::int32_t{basis.healthy});
  group.write_attribute("explanation", basis.explanation);
  write_plant_dimensions(group, study.plant);
  write_operating_point(group, study, basis.point);

  const Eigen::Index samples = study.simulation.samples;
  write_sample_dimension(group, "sample", "sample number", "time", study, 0, samples);
  for (const SignalColumn& column : signal_columns(study))
    write_matrices(group, {column.rows, "sample"}, column.text, {&(basis.trajectory.*column.member)},
                   row_count(column, study), samples);
  for (const auto& [text, member] : nominal_columns(study))
    write_matrices(group, {"cv", "sample"}, text, {&(basis.nominal.*member)}, study.cv_count(), samples);
  write_columns(group, {}, loop_columns(), {&basis.trajectory});
  write_columns(group, {}, solver_columns(), {&basis.trajectory.solver});
  write_autocorrelations(group, study, basis);
  if (basis.trajectory.status == ControlStatus::ok)
    write_numbers(group, chain_assessment(study, chain_numbers(basis.diagnosis)));
}

BasisCase read_basis(const Hdf5Group& root, const Study& study, NominalSensitivity sensitivity,
                     const std::string& file) {
  const Hdf5Group group = root.group(kBasisGroup);
  BasisCase basis;
  basis.healthy = group.attribute<std::int32_t>("healthy") != 0;
  basis.explanation = group.attribute<std::string>("explanation");
  basis.point = read_operating_point(group, study);
  basis.point.active = sensitivity.active;
  basis.sensitivity = std::move(sensitivity);

  const Eigen::Index samples = study.simulation.samples;
  read_columns(group, {}, loop_columns(), {&basis.trajectory}, file);
  read_columns(group, {}, solver_columns(), {&basis.trajectory.solver}, file);
  for (const SignalColumn& column : signal_columns(study))
    read_matrices(group, column.text.name, false, {&(basis.trajectory.*column.member)},
                  row_count(column, study), samples);
  const bool complete = basis.trajectory.status == ControlStatus::ok;  // otherwise there is no diagnosis
  for (const auto& [text, member] : nominal_columns(study)) {
    Eigen::MatrixXd signal;
    read_matrices(group, text.name, false, {&signal}, study.cv_count(), samples);
    if (complete)
      basis.nominal.*member = signal;
  }
  if (complete) {
    AssessmentRecord assessment = chain_assessment(study, {});
    read_numbers(group, assessment, file);
    basis.diagnosis = diagnosis_of(assessment);
  }
  return basis;
}

}  // namespace mpm
