// The records of the experiments: every table of record_tables(), each in its group.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/columns.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/record_subset.hpp"
#include "results/archive/record_tables.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

using Records = std::vector<ExperimentRecord>;

/// The indices of the experiments that stand in each table; those of all experiments once.
class TableIndices {
 public:
  TableIndices(const std::vector<RecordTable>& tables, const RecordRange& records) : of_(tables.size()) {
    all_.reserve(records.size());
    records.each([&](const ExperimentRecord& record) {
      all_.push_back(record.draw.index);
      for (std::size_t t = 0; t < tables.size(); ++t)
        if (tables[t].has && tables[t].has(record))
          of_[t].push_back(record.draw.index);
    });
    for (const RecordTable& table : tables)
      whole_.push_back(!table.has);
  }

  const std::vector<std::int64_t>& of(std::size_t table) const { return whole_[table] ? all_ : of_[table]; }

 private:
  std::vector<std::int64_t> all_;
  std::vector<std::vector<std::int64_t>> of_;
  std::vector<bool> whole_;
};

/// The group with this path, made unless it is there; `made` keeps those that are.
Hdf5Group& group_of(std::map<std::string, Hdf5Group>& made, const std::string& path) {
  if (const auto found = made.find(path); found != made.end())
    return found->second;
  const std::size_t slash = path.rfind('/');
  const std::string parent = slash == std::string::npos ? "" : path.substr(0, slash);
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  return made.emplace(path, group_of(made, parent).create_group(name)).first->second;
}

Hdf5Group group_at(const Hdf5Group& root, const std::string& path) {
  const std::size_t slash = path.find('/');
  return path.empty()                 ? root
         : slash == std::string::npos ? root.group(path)
                                      : group_at(root.group(path.substr(0, slash)), path.substr(slash + 1));
}

/// The windows by their number, and when each ends: that is when its verdict is there.
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

/// `variable` must outlive it.
VariableWriter variable_writer(Hdf5Group& group, const RecordTable& table, const RecordVariable& variable) {
  std::vector<std::string> dimensions{table.dimension};
  dimensions.insert(dimensions.end(), variable.dimensions.begin(), variable.dimensions.end());
  return std::visit(
      [&]<class T>(const RecordAccess<T>& access) -> VariableWriter {
        const auto rows = std::make_shared<Hdf5Rows<T>>(
            group.create_rows<T>(variable.text.name, dimensions, attributes<T>(variable.text)));
        return {[rows, &access](const ExperimentRecord& record) { access.get(record, rows->add()); },
                [rows] { rows->finish(); }};
      },
      variable.access);
}

/// The variables of a table.
struct TableWriter {
  const RecordTable* table;
  std::vector<VariableWriter> variables = {};

  void add(const ExperimentRecord& record) const {
    if (!table->has || table->has(record))
      for (const VariableWriter& variable : variables)
        variable.add(record);
  }
};

void read_variable(const Hdf5Group& group, const RecordVariable& variable,
                   const std::vector<ExperimentRecord*>& records, const std::string& file) {
  std::vector<std::size_t> shape{records.size()};
  shape.insert(shape.end(), variable.shape.begin(), variable.shape.end());
  std::visit(
      [&]<class T>(const RecordAccess<T>& access) {
        const std::vector<T> values = group.read<T>(variable.text.name, shape);
        require_flags(variable.text, values, file);
        const T* place = values.data();
        for (ExperimentRecord* record : records) {
          access.set(*record, place);
          place += variable.size();
        }
      },
      variable.access);
}

/// A changed tuning is that of a weight which the controller has.
bool is_possible(const TuningChange& tuning, const MpcOptions& controller) {
  if (tuning.parameter < TuningParameter::move_suppression)
    return false;
  const std::vector<Eigen::Index> variables = variables_with(controller, tuning.parameter);
  return std::find(variables.begin(), variables.end(), tuning.index) != variables.end();
}

/// What the variables cannot see one by one: an experiment with a fault has it somewhere, a fault with a
/// mismatch has a channel and a parameter, a changed tuning a weight, and a verdict names a CV. Everything
/// that counts takes this as given.
void require_consistent(const ExperimentRecord& record, const Study& study, const std::string& file) {
  const auto require = [&](bool condition, const std::string& variable, const char* allowed) {
    if (!condition)
      throw ArchiveError(fmt::format("{}: variable '{}': found none in experiment {}; allowed: {}", file,
                                     variable, record.draw.index, allowed));
  };
  const ExperimentDraw& draw = record.draw;
  if (!draw.named) {
    require(study.experiments.of(draw.kind) > 0, "kind", "a kind that the study counts");
    require(is_faultless(draw.kind) || draw.true_cv() >= 0 || !study.has_plain_faults(), "true_cv",
            "the CV of the fault");
    if (draw.tuning) {
      require(is_possible(*draw.tuning, study.controller), "tuning_index", "a variable with this weight");
      require(std::isfinite(draw.tuning->factor) && draw.tuning->factor > 0.0, "tuning_factor",
              "a number > 0");
    }
    for (const Mismatch& mismatch : draw.mismatches) {
      require(mismatch.input >= 0, "true_mv", "the MV of the mismatch");
      require(mismatch.parameter >= MismatchParameter::gain, "parameter", "the parameter of the mismatch");
    }
  }
  for (const AssessmentRecord& assessment : record.assessments) {
    require(record.status == ExperimentStatus::ok || !assessment.answered(), "assessment_status",
            "a verdict on a loop that ran to its end");
    if (assessment.answered() && assessment.flagged && assessment.form->method().locates_cvs)
      require(assessment.predicted_cv >= 0, "predicted_cv", "a CV for a loop that is flagged");
  }
}

/// Does the study say more of its experiments than the variables of an archive do?
bool has_further_draws(const Study& study) {
  return study.names_scenarios() || !study.has_plain_faults();
}

/// The draw of a record from the study, whose faults are in no variable or not all of them; its scales are in
/// variables.
void take_draw(ExperimentRecord& record, const Study& study, const std::string& file) {
  if (study.names_scenarios() && record.draw.index >= study.experiment_count())
    throw ArchiveError(
        fmt::format("{}: variable 'experiment': found {}; allowed: 0 to {}, the scenarios of "
                    "the study",
                    file, record.draw.index, study.experiment_count() - 1));
  ExperimentDraw draw = with_scales(study, draw_experiment(study, record.draw.index), record.draw.scales);
  const auto require = [&](bool condition, const char* variable, const std::string& allowed) {
    if (!condition)
      throw ArchiveError(
          fmt::format("{}: variable '{}': found another value in experiment {}; allowed: {}, "
                      "as in the study",
                      file, variable, record.draw.index, allowed));
  };
  require(record.draw.kind == draw.kind, "kind", std::string(to_string(draw.kind)));
  require(record.draw.true_cv() == draw.true_cv(), "true_cv", fmt::format("{}", draw.true_cv()));
  record.draw = std::move(draw);
}

/// In the order of their index, none twice.
void require_order(const std::vector<std::int64_t>& indices, const std::string& file) {
  const auto place = std::adjacent_find(indices.begin(), indices.end(), std::greater_equal<>());
  if (place != indices.end())
    throw ArchiveError(fmt::format("{}: variable 'experiment': found {} after {}; allowed: indices that grow",
                                   file, *(place + 1), *place));
  if (!indices.empty() && indices.front() < 0)
    throw ArchiveError(
        fmt::format("{}: variable 'experiment': found {}; allowed: 0 or more", file, indices.front()));
}

/// A number that the method itself gives, not one that follows from what it tells.
bool is_own(const AssessmentRecord& assessment, const std::string& name) {
  const std::vector<AssessmentNumberInfo>& numbers = assessment.form->method().numbers;
  return std::any_of(numbers.begin(), numbers.end(), [&](const auto& number) { return number.name == name; });
}

}  // namespace

void write_records(Hdf5Group& root, const Campaign& campaign) {
  std::map<std::string, Hdf5Group> groups{{"", root}};
  std::map<std::string, std::set<std::string>> dimensions;  // of each group
  const std::vector<RecordTable> tables = record_tables(campaign.study, forms_of(campaign));
  const RecordRange records = records_of(campaign);
  const TableIndices indices(tables, records);
  std::vector<TableWriter> writers;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const RecordTable& table = tables[t];
    if (table.dimension == "stored" && indices.of(t).empty())
      continue;  // no loop was kept
    Hdf5Group& group = group_of(groups, table.group);
    if (!table.title.empty())
      group.write_attribute("title", table.title);
    std::set<std::string>& known = dimensions[table.group];
    if (known.insert(table.dimension).second)
      group.write_dimension(
          table.dimension, indices.of(t),
          attributes<std::int64_t>({table.dimension, "index of the experiment in the study"}));
    if (table.group.empty())
      for (const char* name : {"cv", "mv", "md", "method"})
        if (known.insert(name).second)
          write_dimension(group, name, campaign);
    TableWriter& writer = writers.emplace_back(TableWriter{&table});
    for (const RecordVariable& variable : table.variables) {
      if (variable.use == RecordUse::bytes_only)
        continue;
      for (const std::string& name : variable.dimensions)
        if (known.insert(name).second)
          write_dimension(group, name, campaign);
      writer.variables.push_back(variable_writer(group, table, variable));
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

void write_numbers(Hdf5Group& group, const AssessmentRecord& assessment) {
  ExperimentRecord holder;
  holder.assessments = {assessment};
  for (const RecordVariable& variable : method_table(*assessment.form, 0).variables)
    if (is_own(assessment, variable.text.name))
      std::visit(
          [&]<class T>(const RecordAccess<T>& access) {
            std::vector<T> values(variable.size());
            access.get(holder, values.data());
            group.write(variable.text.name, variable.dimensions, values, attributes<T>(variable.text));
          },
          variable.access);
}

void read_numbers(const Hdf5Group& group, AssessmentRecord& assessment, const std::string& file) {
  ExperimentRecord holder;
  holder.assessments = {assessment};
  for (const RecordVariable& variable : method_table(*assessment.form, 0).variables)
    if (is_own(assessment, variable.text.name))
      std::visit(
          [&]<class T>(const RecordAccess<T>& access) {
            const std::vector<T> values = group.read<T>(variable.text.name, variable.shape);
            require_flags(variable.text, values, file);
            access.set(holder, values.data());
          },
          variable.access);
  assessment = std::move(holder.assessments.front());
}

std::vector<ExperimentRecord> read_records(const Hdf5Group& root, const Study& study,
                                           const AssessmentForms& forms, const std::string& file) {
  const std::vector<std::int64_t> indices = root.read_list<std::int64_t>("experiment");
  require_order(indices, file);
  Records records(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i)
    records[i].draw.index = indices[i];
  for (const RecordTable& table : record_tables(study, forms)) {
    if (table.dimension == "stored" && !root.has_group(table.group))
      continue;
    const Hdf5Group group = group_at(root, table.group);
    const std::vector<ExperimentRecord*> along =
        records_along(group, table.group, table.dimension, records, file);
    if (!table.has && along.size() != records.size())
      throw ArchiveError(
          fmt::format("{}: dimension '/{}/{}': found {} experiments; allowed: the {} of the root "
                      "group",
                      file, table.group, table.dimension, along.size(), records.size()));
    if (table.make)
      for (ExperimentRecord* record : along)
        table.make(*record);
    for (const RecordVariable& variable : table.variables)
      if (variable.use == RecordUse::everywhere)
        read_variable(group, variable, along, file);
  }
  for (ExperimentRecord& record : records) {
    if (has_further_draws(study))
      take_draw(record, study, file);
    require_consistent(record, study, file);
  }
  return records;
}

}  // namespace mpm
