#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "analysis/experiment/scenario_verdict.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/column_io.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/matrix_io.hpp"

namespace mpm {
namespace {

constexpr const char* kGroup = "scenarios";

std::vector<std::int64_t> indices_of(const std::vector<ExperimentRecord>& records) {
  std::vector<std::int64_t> indices;
  for (const ExperimentRecord& record : records)
    indices.push_back(record.draw.index);
  return indices;
}

void write_names(Hdf5Group& group, const Study& study, const std::vector<ExperimentRecord>& records) {
  std::vector<std::string> names, descriptions;
  for (const ExperimentRecord& record : records) {
    const Scenario& scenario = study.scenarios[static_cast<std::size_t>(record.draw.index)];
    names.push_back(scenario.name);
    descriptions.push_back(scenario.description);
  }
  group.write("name", {"experiment"}, names, attributes<std::string>({"name", "name of the scenario"}));
  group.write("description", {"experiment"}, descriptions,
              attributes<std::string>({"description", "what the study says of the scenario"}));
}

void write_affected(Hdf5Group& group, const Study& study, const std::vector<ExperimentRecord>& records) {
  const auto ny = static_cast<std::size_t>(study.cv_count());
  std::vector<std::int8_t> values(records.size() * ny, static_cast<std::int8_t>(ExperimentKind::none));
  for (std::size_t i = 0; i < records.size(); ++i)
    for (const AffectedCv& affected : records[i].draw.affected())
      values[i * ny + static_cast<std::size_t>(affected.cv)] = static_cast<std::int8_t>(affected.by);
  const VariableText text{"affected", "what affects the CV, as the study says it", "1",
                          "mpm: model-plant mismatch; ud: unmeasured disturbance; mpm_ud: both",
                          kind_flags()};
  group.write(text.name, {"experiment", "cv"}, values, attributes<std::int8_t>(text));
}

void write_totals(Hdf5Group& group, const std::vector<ExperimentRecord>& records) {
  std::vector<double> values;
  for (const ExperimentRecord& record : records)
    values.push_back(total_simulation_error(record.diagnosis));
  group.write("tsse", {"experiment"}, values,
              attributes<double>({"tsse", "TSSE = sum of SSE over the CVs", "1",
                                  "units of the CVs added up; NaN unless the status is ok"}));
}

using AcfCurve = std::pair<const char*, AcfFeatures AcfComparison::*>;
constexpr std::array<AcfCurve, 3> kAcfCurves{
    {{"y", &AcfComparison::y}, {"y0", &AcfComparison::y0}, {"y0_diag", &AcfComparison::y0_diag}}};

/// Lags 0 ... a quarter of the record, as `AcfComparisonOptions` has it.
Eigen::Index lag_count(const Study& study) {
  return study.simulation.samples / 4 + 1;
}

/// The functions of all CVs, one row each; empty when there are none.
Eigen::MatrixXd curves_of(const std::vector<const AcfComparison*>& cvs, AcfFeatures AcfComparison::*member) {
  if (cvs.empty())
    return {};
  Eigen::MatrixXd curves(static_cast<Eigen::Index>(cvs.size()), ((*cvs.front()).*member).values.size());
  for (std::size_t cv = 0; cv < cvs.size(); ++cv)
    curves.row(static_cast<Eigen::Index>(cv)) = ((*cvs[cv]).*member).values.transpose();
  return curves;
}

/// Functions of every CV for each list of comparisons, as (list, CV, lag), or (CV, lag) for one list.
void write_curves(Hdf5Group& group, const Study& study, const std::string& prefix,
                  const std::vector<std::string>& dimensions,
                  const std::vector<std::vector<const AcfComparison*>>& lists) {
  for (const auto& [of, member] : kAcfCurves) {
    std::vector<Eigen::MatrixXd> curves;
    for (const auto& list : lists)
      curves.push_back(curves_of(list, member));
    std::vector<const Eigen::MatrixXd*> pointers;
    for (const Eigen::MatrixXd& curve : curves)
      pointers.push_back(&curve);
    write_matrices(group, dimensions,
                   {prefix + "acf_" + of,
                    std::string("autocorrelation of ") + of,
                    "1",
                    "about the setpoint of a CV that has one; NaN unless the status is ok",
                    {},
                    "lag_time"},
                   pointers, study.cv_count(), lag_count(study));
  }
}

/// The reverse of write_curves() for lists of `study.cv_count()` comparisons.
void read_curves(const Hdf5Group& group, const Study& study, const std::string& prefix, bool stacked,
                 std::vector<std::vector<AcfComparison*>>& lists) {
  for (const auto& [of, member] : kAcfCurves) {
    std::vector<Eigen::MatrixXd> curves(lists.size());
    std::vector<Eigen::MatrixXd*> pointers;
    for (Eigen::MatrixXd& curve : curves)
      pointers.push_back(&curve);
    read_matrices(group, prefix + "acf_" + of, stacked, pointers, study.cv_count(), lag_count(study));
    for (std::size_t list = 0; list < lists.size(); ++list)
      for (std::size_t cv = 0; cv < lists[list].size(); ++cv)
        ((*lists[list][cv]).*member).values = curves[list].row(static_cast<Eigen::Index>(cv)).transpose();
  }
}

void write_basis_acf(Hdf5Group& group, const Study& study, const BasisCase& basis) {
  const AcfComparison none;
  std::vector<const AcfComparison*> cvs;
  for (std::size_t cv = 0; cv < study.plant.cvs.size(); ++cv)
    cvs.push_back(basis.acf.empty() ? &none : &basis.acf[cv]);
  write_columns(group, {"cv"}, basis_acf_columns(), cvs);
  write_curves(group, study, "basis_", {"cv", "lag"},
               {basis.acf.empty() ? std::vector<const AcfComparison*>{} : cvs});
}

}  // namespace

void write_scenarios(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  const std::vector<ExperimentRecord>& records = campaign.records;
  if (!study.names_scenarios())
    return;
  Hdf5Group group = root.create_group(kGroup);
  group.write_attribute("title", "Named scenarios: what the study says of each CV, and what the chain says");
  group.write_dimension("experiment", indices_of(records),
                        attributes<std::int64_t>({"experiment", "index of the experiment in the study"}));
  write_variable_dimension(group, "cv", "controlled variable", study.plant.cvs);
  write_names(group, study, records);
  write_affected(group, study, records);
  write_totals(group, records);

  const CvDiagnosis none;
  std::vector<const CvDiagnosis*> cvs;
  for (const ExperimentRecord& record : records)
    for (std::size_t cv = 0; cv < study.plant.cvs.size(); ++cv)
      cvs.push_back(record.diagnosis.cvs.empty() ? &none : &record.diagnosis.cvs[cv]);
  write_columns(group, {"experiment", "cv"}, cv_columns(), cvs);

  write_sample_dimension(group, "lag", "lag in samples", "lag_time", study, 0, lag_count(study));
  std::vector<std::vector<const AcfComparison*>> acf;
  for (const ExperimentRecord& record : records) {
    acf.emplace_back();
    for (const CvDiagnosis& cv : record.diagnosis.cvs)
      acf.back().push_back(&cv.acf);
  }
  write_curves(group, study, "", {"experiment", "cv", "lag"}, acf);
  write_basis_acf(group, study, campaign.basis);
}

void read_scenarios(const Hdf5Group& root, const Study& study, std::vector<ExperimentRecord>& records,
                    const std::string& file) {
  if (!study.names_scenarios())
    return;
  const Hdf5Group group = root.group(kGroup);
  const std::size_t ny = study.plant.cvs.size();
  std::vector<CvDiagnosis> all(records.size() * ny);
  std::vector<CvDiagnosis*> cvs;
  for (CvDiagnosis& cv : all)
    cvs.push_back(&cv);
  read_columns(group, {records.size(), ny}, cv_columns(), cvs, file);
  std::vector<std::vector<AcfComparison*>> acf(records.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    acf[i / ny].push_back(&all[i].acf);
  read_curves(group, study, "", true, acf);
  auto next = all.cbegin();
  for (ExperimentRecord& record : records) {
    const auto end = next + static_cast<std::ptrdiff_t>(ny);
    if (record.status == ExperimentStatus::ok)  // the others have no diagnosis
      record.diagnosis.cvs.assign(next, end);
    next = end;
  }
}

void read_basis_acf(const Hdf5Group& root, const Study& study, BasisCase& basis, const std::string& file) {
  if (!study.names_scenarios() || basis.trajectory.status != ControlStatus::ok)
    return;
  const Hdf5Group group = root.group(kGroup);
  const std::size_t ny = study.plant.cvs.size();
  basis.acf.assign(ny, {});
  std::vector<AcfComparison*> cvs;
  for (AcfComparison& cv : basis.acf)
    cvs.push_back(&cv);
  read_columns(group, {ny}, basis_acf_columns(), cvs, file);
  std::vector<std::vector<AcfComparison*>> lists{cvs};
  read_curves(group, study, "basis_", false, lists);
}

}  // namespace mpm
