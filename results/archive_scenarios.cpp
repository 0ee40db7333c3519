#include <cstddef>
#include <cstdint>

#include "analysis/scenario_verdict.hpp"
#include "results/archive_groups.hpp"
#include "results/column_io.hpp"
#include "results/dimensions.hpp"

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
  auto next = all.cbegin();
  for (ExperimentRecord& record : records) {
    const auto end = next + static_cast<std::ptrdiff_t>(ny);
    if (record.status == ExperimentStatus::ok)  // the others have no diagnosis
      record.diagnosis.cvs.assign(next, end);
    next = end;
  }
}

}  // namespace mpm
