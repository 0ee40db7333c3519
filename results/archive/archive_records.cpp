// The records of the experiments: every table of record_tables(), each in its group.

#include <functional>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/row_io.hpp"

namespace mpm {
namespace {

/// Returns how many experiments are in each table.
std::vector<std::size_t> lengths_of(const std::vector<RecordTable>& tables, const RecordRange& records) {
  std::vector<std::size_t> lengths(tables.size(), 0);
  records.each([&](const ExperimentRecord& record) {
    for (std::size_t t = 0; t < tables.size(); ++t)
      lengths[t] += tables[t].covers(record) ? 1 : 0;
  });
  return lengths;
}

/// Returns the group with this path and creates it if it is missing; `made` keeps the groups created so far.
Hdf5Group& group_of(std::map<std::string, Hdf5Group>& made, const std::string& path) {
  if (const auto found = made.find(path); found != made.end())
    return found->second;
  const std::size_t slash = path.rfind('/');
  const std::string parent = slash == std::string::npos ? "" : path.substr(0, slash);
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  return made.emplace(path, group_of(made, parent).create_group(name)).first->second;
}

/// Writes the number of each window and the time at which it ends, when its verdict is available.
void write_windows(Hdf5Group& group, const Study& study) {
  std::vector<std::int32_t> numbers;
  std::vector<double> ends;
  for (int window = 0; window < study.monitoring->count(study.simulation.samples); ++window) {
    numbers.push_back(window);
    ends.push_back(study.monitoring->end(window) * study.controller.sample_time);
  }
  group.write_dimension("window", numbers,
                        attributes<std::int32_t>({"window", "number of the moving window"}));
  group.write(
      "window_end", {"window"}, ends,
      attributes<double>({"window_end", "time at which the window ends", unit_text(study.plant.time_unit)}));
}

void write_dimension(Hdf5Group& group, const std::string& name, const Campaign& campaign) {
  const Study& study = campaign.study;
  if (name == "cv")
    write_variable_dimension(group, name, "controlled variable", study.plant.cvs);
  else if (name == "mv")
    write_variable_dimension(group, name, "manipulated variable", study.plant.mvs);
  else if (name == "md")
    write_variable_dimension(group, name, "measured disturbance", study.plant.mds);
  else if (name == "sample")
    write_sample_dimension(group, name, "sample number", "time", study, 0, study.simulation.samples);
  else if (name == "lag")
    write_sample_dimension(group, name, "lag in samples", "lag_time", study, 0, lag_count(study));
  else if (name == "window")
    write_windows(group, study);
  else if (name == "multiplier")
    group.write_dimension(name, study.s0_perturbation.multipliers,
                          attributes<double>({name, "multiplier of the time constant or the damping of S0"}));
  else
    group.write_dimension(name, method_names(campaign),
                          attributes<std::string>({name, "method of assessment"}));
}

/// A variable of the file that takes one record after the other.
struct VariableWriter {
  std::function<void(const ExperimentRecord&)> add;
  std::function<void()> finish;
};

/// Writes rows; write(record, place) puts the values of each record in its row.
template <class T, class Write>
VariableWriter writer_of(Hdf5Rows<T> rows, const Write& write) {
  const auto shared = std::make_shared<Hdf5Rows<T>>(std::move(rows));
  return {[shared, write](const ExperimentRecord& record) { write(record, shared->add()); },
          [shared] { shared->finish(); }};
}

/// Writes the indices of the experiments that are in a table.
VariableWriter index_writer(Hdf5Group& group, const RecordTable& table, std::size_t length) {
  const NumberText text{table.dimension, "index of the experiment in the study"};
  return writer_of(
      group.create_dimension<std::int64_t>(table.dimension, length, attributes<std::int64_t>(text)),
      [](const ExperimentRecord& record, std::int64_t* place) { *place = record.draw.index; });
}

/// `row` must outlive the writer.
VariableWriter variable_writer(Hdf5Group& group, const RecordTable& table, const RecordRow& row) {
  std::vector<std::string> dimensions{table.dimension};
  dimensions.insert(dimensions.end(), row.dimensions.begin(), row.dimensions.end());
  return std::visit(
      [&]<class T>(const RowAccess<ExperimentRecord, T>& access) {
        return writer_of(group.create_rows<T>(row.text.name, dimensions, attributes<T>(row)),
                         [&access](const ExperimentRecord& record, T* place) { access.get(record, place); });
      },
      row.access);
}

/// The variables of a table.
struct TableWriter {
  const RecordTable* table;
  std::vector<VariableWriter> variables = {};

  void add(const ExperimentRecord& record) const {
    if (table->covers(record))
      for (const VariableWriter& variable : variables)
        variable.add(record);
  }
};

}  // namespace

void write_records(Hdf5Group& root, const Campaign& campaign, const std::vector<RecordTable>& tables) {
  std::map<std::string, Hdf5Group> groups{{"", root}};
  std::map<std::string, std::set<std::string>> dimensions;  // of each group
  const RecordRange records = records_of(campaign);
  const std::vector<std::size_t> lengths = lengths_of(tables, records);
  std::vector<TableWriter> writers;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const RecordTable& table = tables[t];
    if (table.dimension == "stored" && lengths[t] == 0)
      continue;  // no loop was kept
    Hdf5Group& group = group_of(groups, table.group);
    if (!table.title.empty())
      group.write_attribute("title", table.title);
    std::set<std::string>& known = dimensions[table.group];
    TableWriter& writer = writers.emplace_back(TableWriter{&table});
    if (known.insert(table.dimension).second)
      writer.variables.push_back(index_writer(group, table, lengths[t]));
    if (table.group.empty())
      for (const char* name : {"cv", "mv", "md", "method"})
        if (known.insert(name).second)
          write_dimension(group, name, campaign);
    for (const RecordRow& row : table.rows) {
      if (row.use == RowUse::bytes_only)
        continue;
      for (const std::string& name : row.dimensions)
        if (known.insert(name).second)
          write_dimension(group, name, campaign);
      writer.variables.push_back(variable_writer(group, table, row));
    }
  }
  records.each([&](const ExperimentRecord& record) {
    for (const TableWriter& writer : writers)
      writer.add(record);
  });
  for (const TableWriter& writer : writers)
    for (const VariableWriter& variable : writer.variables)
      variable.finish();
}

}  // namespace mpm
