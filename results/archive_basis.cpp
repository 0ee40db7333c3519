#include <algorithm>
#include <array>
#include <utility>

#include "analysis/autocorrelation.hpp"
#include "results/archive_groups.hpp"
#include "results/column_io.hpp"
#include "results/dimensions.hpp"
#include "results/matrix_io.hpp"

namespace mpm {
namespace {

struct NominalColumn {
  const char* name;
  const char* long_name;
  Eigen::MatrixXd NominalOutputs::*member;
};

constexpr std::array<NominalColumn, 3> kNominalColumns{
    {{"y_sim", "output of the nominal model, G0 (u, d)", &NominalOutputs::y_sim},
     {"y0", "nominal output, y + S0 (y_sim - y)", &NominalOutputs::y0},
     {"y0_diag", "diagonal nominal output, y + S0_diag (y_sim - y)", &NominalOutputs::y0_diag}}};

Eigen::MatrixXd autocorrelations(const Eigen::MatrixXd& signals, Eigen::Index max_lag) {
  Eigen::MatrixXd result(signals.rows(), max_lag + 1);
  for (Eigen::Index i = 0; i < signals.rows(); ++i)
    result.row(i) = autocorrelation(signals.row(i).transpose(), max_lag).values.transpose();
  return result;
}

void write_acf(Hdf5Group& group, const Study& study, const std::string& of, const Eigen::MatrixXd& signals) {
  const Eigen::Index max_lag =
      std::min<Eigen::Index>(2 * study.controller.prediction_horizon, signals.cols() - 1);
  const Eigen::MatrixXd acf = autocorrelations(signals, max_lag);
  write_matrices(group, {"cv", "acf_lag"}, {"acf_" + of, "autocorrelation function of " + of}, {&acf},
                 study.cv_count(), max_lag + 1);
}

void write_acf_dimension(Hdf5Group& group, const Study& study) {
  const Eigen::Index last =
      std::min<Eigen::Index>(2 * study.controller.prediction_horizon, study.simulation.samples - 1);
  std::vector<std::int32_t> lags;
  for (Eigen::Index lag = 0; lag <= last; ++lag)
    lags.push_back(static_cast<std::int32_t>(lag));
  group.write_dimension("acf_lag", lags, attributes<std::int32_t>({"acf_lag", "lag in samples"}));
}

}  // namespace

void write_basis(Hdf5Group& root, const Study& study, const BasisCase& basis) {
  Hdf5Group group = root.create_group("basis");
  group.write_attribute("healthy", static_cast<std::int32_t>(basis.healthy));
  group.write_attribute("explanation", basis.explanation);
  write_plant_dimensions(group, study.plant);
  write_sample_dimension(group, "sample", "sample", study, 0, study.simulation.samples);
  write_columns(group, {}, loop_columns(), std::vector<const Trajectory*>{&basis.trajectory});
  for (const SignalColumn& signal : signal_columns(study)) {
    const Eigen::MatrixXd& values = basis.trajectory.*signal.member;
    write_matrices(group, {signal.rows, "sample"}, signal.text, {&values}, values.rows(), values.cols());
  }
  const std::string unit = common_unit(study.plant.cvs);
  for (const NominalColumn& column : kNominalColumns)
    write_matrices(group, {"cv", "sample"}, {column.name, column.long_name, unit},
                   {&(basis.nominal.*column.member)}, study.cv_count(), study.simulation.samples);
  for (const CvColumn<Diagnosis>& column : variance_columns())
    write_vectors(group, {"cv"}, column.text, {&(basis.diagnosis.*column.member)}, study.cv_count());
  write_vectors(group, {"cv"},
                {"operating_point_y", "CVs at the economic optimum without disturbances", unit},
                {&basis.point.y}, study.cv_count());
  write_vectors(
      group, {"mv"},
      {"operating_point_u", "MVs at the economic optimum without disturbances", common_unit(study.plant.mvs)},
      {&basis.point.u}, study.mv_count());
  if (basis.trajectory.status != ControlStatus::ok)
    return;
  write_acf_dimension(group, study);
  write_acf(group, study, "y", basis.trajectory.y);
  for (const NominalColumn& column : kNominalColumns)
    if (column.member != &NominalOutputs::y_sim)
      write_acf(group, study, column.name, basis.nominal.*column.member);
}

BasisCase read_basis(const Hdf5Group& root, const Study& study, NominalSensitivity sensitivity,
                     const std::string& file) {
  const Hdf5Group group = root.group("basis");
  BasisCase basis;
  basis.sensitivity = std::move(sensitivity);
  basis.healthy = group.attribute<std::int32_t>("healthy") != 0;
  basis.explanation = group.attribute<std::string>("explanation");
  read_columns(group, {}, loop_columns(), std::vector<Trajectory*>{&basis.trajectory}, file);
  const Eigen::Index samples = study.simulation.samples;
  const auto rows = [&](const std::string& dimension) {
    return dimension == "cv" ? study.cv_count() : dimension == "mv" ? study.mv_count() : study.md_count();
  };
  for (const SignalColumn& signal : signal_columns(study))
    read_matrices(group, signal.text.name, false, {&(basis.trajectory.*signal.member)}, rows(signal.rows),
                  samples);
  for (const NominalColumn& column : kNominalColumns)
    read_matrices(group, column.name, false, {&(basis.nominal.*column.member)}, study.cv_count(), samples);
  for (const CvColumn<Diagnosis>& column : variance_columns())
    basis.diagnosis.*column.member =
        read_vectors(group, column.text.name, false, 1, study.cv_count()).front();
  basis.point.y = read_vectors(group, "operating_point_y", false, 1, study.cv_count()).front();
  basis.point.u = read_vectors(group, "operating_point_u", false, 1, study.mv_count()).front();
  basis.point.active = basis.sensitivity.active;
  return basis;
}

}  // namespace mpm
