#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "results/archive/archive_groups.hpp"
#include "results/archive/columns.hpp"
#include "results/archive/dimensions.hpp"

namespace mpm {
namespace {

constexpr const char* kScenariosGroup = "scenarios";

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
  std::vector<std::int8_t> values(records.size() * ny, static_cast<std::int8_t>(FaultSource::none));
  for (std::size_t i = 0; i < records.size(); ++i)
    for (const AffectedCv& affected : records[i].draw.affected())
      values[i * ny + static_cast<std::size_t>(affected.cv)] = static_cast<std::int8_t>(affected.by);
  const VariableText text{
      "affected", "what affects the CV, as the study says it", "1",
      "mpm: model-plant mismatch; ud: unmeasured disturbance; mpm_ud: both",
      enum_flags(std::array{FaultSource::none, FaultSource::mpm, FaultSource::ud, FaultSource::mpm_ud})};
  group.write(text.name, {"experiment", "cv"}, values, attributes<std::int8_t>(text));
}

void write_totals(Hdf5Group& group, const std::vector<ExperimentRecord>& records) {
  std::vector<double> values;
  for (const ExperimentRecord& record : records)
    values.push_back(total_simulation_error(record.chain()));
  group.write("tsse", {"experiment"}, values,
              attributes<double>({"tsse", "TSSE = sum of SSE over the CVs", "1",
                                  "units of the CVs added up; NaN without a verdict of the chain"}));
}

}  // namespace

void write_scenarios(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  const std::vector<ExperimentRecord>& records = campaign.records;
  if (!study.names_scenarios())
    return;
  Hdf5Group group = root.create_group(kScenariosGroup);
  group.write_attribute("title", "Named scenarios: what the study says of each CV, and what the chain says");
  group.write_dimension("experiment", indices_of(records),
                        attributes<std::int64_t>({"experiment", "index of the experiment in the study"}));
  write_variable_dimension(group, "cv", "controlled variable", study.plant.cvs);
  write_names(group, study, records);
  write_affected(group, study, records);
  write_totals(group, records);
}

}  // namespace mpm
