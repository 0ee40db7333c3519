#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/row_io.hpp"

namespace mpm {
namespace {

constexpr const char* kScenariosGroup = "scenarios";

std::vector<std::int64_t> indices_of(const std::vector<ExperimentRecord>& records) {
  std::vector<std::int64_t> indices;
  for (const ExperimentRecord& record : records)
    indices.push_back(record.draw.index);
  return indices;
}

std::vector<RecordRow> scenario_truth_rows(const Study& study) {
  using Record = ExperimentRecord;
  const auto said = [&study](const Record& record) -> const Scenario& {
    return study.scenarios[static_cast<std::size_t>(record.draw.index)];
  };
  static_assert(static_cast<int>(FaultSource::none) == 0);  // a CV that no fault affects keeps this value
  const RowAccess<Record, std::int8_t> affected{[](const Record& record, std::int8_t* sources) {
    for (const AffectedCv& each : record.draw.affected())
      sources[each.cv] = static_cast<std::int8_t>(each.by);
  }};
  return {
      value_row<std::string, Record>({"name", "name of the scenario"},
                                     [said](const Record& record) { return said(record).name; }),
      value_row<std::string, Record>({"description", "description of the scenario in the study"},
                                     [said](const Record& record) { return said(record).description; }),
      {{"affected", "faults that affect the CV, according to the study", "1",
        "mpm: model-plant mismatch; ud: unmeasured disturbance; mpm_ud: both",
        enum_words(std::array{FaultSource::none, FaultSource::mpm, FaultSource::ud, FaultSource::mpm_ud})},
       {"cv"},
       {study.plant.cvs.size()},
       affected},
      value_row<double, Record>({"tsse", "TSSE = sum of SSE over the CVs", "1",
                                 "units of the CVs added up; NaN without a verdict of the chain"},
                                [](const Record& record) { return total_simulation_error(record.chain()); })};
}

}  // namespace

void write_scenarios(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  const std::vector<ExperimentRecord>& records = campaign.records;
  if (!study.names_scenarios())
    return;
  Hdf5Group group = root.create_group(kScenariosGroup);
  group.write_attribute("title", "Named scenarios: each CV according to the study and to the chain");
  group.write_dimension("experiment", indices_of(records),
                        attributes<std::int64_t>({"experiment", "index of the experiment in the study"}));
  write_variable_dimension(group, "cv", "controlled variable", study.plant.cvs);
  store_rows(group, {"experiment"}, scenario_truth_rows(study), records);
}

}  // namespace mpm
