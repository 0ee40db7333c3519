#include <cstdint>
#include <string>
#include <utility>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/statistics/autocorrelation.hpp"
#include "base/non_finite.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/loop_rows.hpp"
#include "results/archive/row_io.hpp"

namespace mpm {
namespace {

constexpr const char* kBasisGroup = "basis";

std::vector<Row<OperatingPoint>> point_rows(const Study& study) {
  using P = OperatingPoint;
  const auto of_file = []<class T>(NumberText text, const char* dimension, Eigen::Index size,
                                   RowAccess<P, T> access) {
    return Row<P>{std::move(text), {dimension}, {static_cast<std::size_t>(size)}, std::move(access)};
  };
  const Eigen::Index ny = study.cv_count(), nu = study.mv_count();
  return {vector_row<P>({"u_operating", "MVs at the operating point", common_unit(study.plant.mvs)}, "mv", nu,
                        &P::u),
          vector_row<P>({"y_operating", "CVs at the operating point", common_unit(study.plant.cvs)}, "cv", ny,
                        &P::y),
          of_file({"active_limit",
                   "soft limit or setpoint at which the CV is held",
                   "1",
                   "",
                   {{-1, "lower"}, {0, "none"}, {1, "upper"}, {2, "setpoint"}}},
                  "cv", ny, RowAccess<P, std::int8_t>{[](const P& point, std::int8_t* limits) {
                    for (const auto& [cv, kind] : point.active)
                      limits[cv] = kind == ConstraintKind::lower_limit ? std::int8_t{-1}
                                                                       : static_cast<std::int8_t>(kind);
                  }}),
          of_file({"fixed_mv", "the MV is at a hard limit and not available for control", "1", "", no_yes()},
                  "mv", nu,
                  RowAccess<P, std::int8_t>{[](const P& point, std::int8_t* fixed) {
                                              for (const Eigen::Index mv : point.fixed_mvs)
                                                fixed[mv] = 1;
                                            },
                                            [nu](P& point, const std::int8_t* fixed) {
                                              for (Eigen::Index mv = 0; mv < nu; ++mv)
                                                if (fixed[mv] != 0)
                                                  point.fixed_mvs.push_back(mv);
                                            }})};
}

/// The numbers of the chain, described as in an answer.
std::vector<Row<Diagnosis>> kept_rows(const Study& study) {
  std::vector<Row<Diagnosis>> rows = diagnosis_rows(study);
  for (Row<Diagnosis>& row : rows)
    row.text = kept_text(row.text);
  return rows;
}

/// Returns the autocorrelation of each row; NaN for a row that has none.
Eigen::MatrixXd autocorrelations(const Eigen::MatrixXd& signal, Eigen::Index rows, Eigen::Index max_lag) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Constant(rows, max_lag + 1, kNaN);
  for (Eigen::Index i = 0; i < signal.rows(); ++i)
    if (signal.row(i).allFinite())
      values.row(i) = autocorrelation(signal.row(i).transpose(), max_lag).values;
  return values;
}

/// Writes the autocorrelations for people: they follow from the signals and are not read back.
void write_autocorrelations(Hdf5Group& group, const Study& study, const BasisCase& basis) {
  const Eigen::Index lags = lag_count(study);
  write_sample_dimension(group, "lag", "lag in samples", "lag_time", study, 0, lags);
  for (const auto& [of, signal] : {std::pair{"y", &basis.trajectory.y}, std::pair{"y0", &basis.nominal.y0},
                                   std::pair{"y0_diag", &basis.nominal.y0_diag}}) {
    const std::string name = of;
    const Row<Eigen::MatrixXd> row = matrix_row<Eigen::MatrixXd>(
        {"acf_" + name, "autocorrelation of " + name, "1", "NaN: the signal is constant, or not known"},
        {"cv", "lag"}, study.cv_count(), lags, [](auto& matrix) -> auto& { return matrix; });
    store_rows<Eigen::MatrixXd>(group, {row.along("lag_time")},
                                autocorrelations(*signal, study.cv_count(), lags - 1));
  }
}

}  // namespace

void write_basis(Hdf5Group& root, const Study& study, const BasisCase& basis) {
  Hdf5Group group = root.create_group(kBasisGroup);
  group.write_attribute("title", "Closed loop without mismatch and unmeasured disturbance");
  group.write_attribute("healthy", std::int32_t{basis.healthy});
  group.write_attribute("explanation", basis.explanation);
  write_plant_dimensions(group, study.plant);
  store_rows(group, point_rows(study), basis.point);
  write_sample_dimension(group, "sample", "sample number", "time", study, 0, study.simulation.samples);
  store_rows(group, signal_rows(study), basis.trajectory);
  store_rows(group, nominal_rows(study), basis.nominal);
  store_rows(group, loop_rows(), basis.trajectory);
  store_rows(group, solver_rows(), basis.trajectory.solver);
  write_autocorrelations(group, study, basis);
  if (basis.trajectory.status == ControlStatus::ok)
    store_rows(group, kept_rows(study), basis.diagnosis);
}

BasisCase read_basis(const Hdf5Group& root, const Study& study, NominalSensitivity sensitivity,
                     const std::string& file) {
  const Hdf5Group group = root.group(kBasisGroup);
  BasisCase basis;
  basis.healthy = group.attribute<std::int32_t>("healthy") != 0;
  basis.explanation = group.attribute<std::string>("explanation");
  load_rows(group, point_rows(study), basis.point, file);
  basis.point.active = sensitivity.active;
  basis.sensitivity = std::move(sensitivity);
  load_rows(group, loop_rows(), basis.trajectory, file);
  load_rows(group, solver_rows(), basis.trajectory.solver, file);
  load_rows(group, signal_rows(study), basis.trajectory, file);
  if (basis.trajectory.status != ControlStatus::ok)
    return basis;  // there are no nominal outputs and no diagnosis
  load_rows(group, nominal_rows(study), basis.nominal, file);
  load_rows(group, kept_rows(study), basis.diagnosis, file);
  return basis;
}

}  // namespace mpm
