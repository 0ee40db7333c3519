#include "results/archive/csv_table.hpp"

#include <algorithm>
#include <functional>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/row_major.hpp"
#include "results/archive/record_tables.hpp"
#include "results/archive/variable_text.hpp"
#include "results/files/csv_text.hpp"
#include "scenarios/loop/historian.hpp"

namespace mpm {
namespace {

constexpr const char* kExperiments = "experiments";
constexpr const char* kFindings = "findings";
constexpr const char* kLoops = "loops";

std::string number(double value) {
  return value != value ? "NaN" : fmt::format("{}", value);
}

template <class T>
std::string cell(const NumberText& text, const T& value) {
  if constexpr (std::is_same_v<T, std::string>)
    return csv_field(value);
  else if constexpr (std::is_same_v<T, double>)
    return number(value);
  else {
    const std::string* const word = word_for(text.words, value);
    return word == nullptr ? fmt::format("{}", value) : csv_field(flag_word(*word));
  }
}

/// Returns the coordinates of a dimension: names if it has them, else numbers.
std::vector<std::string> coordinates(const Campaign& campaign, const std::string& dimension,
                                     std::size_t length) {
  const Study& study = campaign.study;
  std::vector<std::string> names;
  const auto take = [&](const std::vector<PlantModel::Variable>& variables) {
    for (const PlantModel::Variable& variable : variables)
      names.push_back(variable.name);
  };
  if (dimension == "cv")
    take(study.plant.cvs);
  else if (dimension == "mv")
    take(study.plant.mvs);
  else if (dimension == "md")
    take(study.plant.mds);
  else if (dimension == "method")
    names = method_names(campaign);
  else
    for (std::size_t i = 0; i < length; ++i)
      names.push_back(fmt::format("{}", i));
  return names;
}

/// Returns the headings of the columns of a row of records, in the order of its values.
std::vector<std::string> headings(const Campaign& campaign, const RecordRow& row, std::size_t dimensions) {
  std::vector<std::string> list{row.text.name};
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::vector<std::string> longer;
    for (const std::string& heading : list)
      for (const std::string& name : coordinates(campaign, row.dimensions[d], row.shape[d]))
        longer.push_back(fmt::format("{}.{}", heading, name));
    list = std::move(longer);
  }
  return list;
}

/// Returns the cells of a row for one record.
std::vector<std::string> cells(const RecordRow& row, const ExperimentRecord& record) {
  std::vector<std::string> list;
  take_values(row, record, [&](const auto& values) {
    for (const auto& value : values)
      list.push_back(cell(row.text, value));
  });
  return list;
}

std::string line(const std::vector<std::string>& fields) {
  return fmt::format("{}\n", fmt::join(fields, ","));
}

void append(std::vector<std::string>&& more, std::vector<std::string>& list) {
  std::move(more.begin(), more.end(), std::back_inserter(list));
}

using Write = std::function<void(std::string_view)>;

void write_findings(const Campaign& campaign, const Write& write) {
  write("name,meaning,form,value,lower,upper,count,hits,reported\n");
  for (const Finding& finding : findings_of(campaign).rows)
    write(
        line({csv_field(finding.name), csv_field(finding.meaning), std::string(to_string(finding.form)),
              number(finding.value), number(finding.interval.lower), number(finding.interval.upper),
              fmt::format("{}", finding.count), fmt::format("{}", finding.hits), number(finding.reported)}));
}

/// A signal that the record showed to the methods differently from its true values.
struct RecordedSignal {
  const char* name;
  const char* variables;
  Eigen::MatrixXd Trajectory::*member;
};

std::vector<RecordedSignal> recorded_signals(const RecordOptions& record) {
  std::vector<RecordedSignal> signals;
  if (record.alters())
    signals.push_back({"y_recorded", "cv", &Trajectory::y});
  if (!record.mv_shift.empty())
    signals.push_back({"u_recorded", "mv", &Trajectory::u});
  if (!record.md_shift.empty())
    signals.push_back({"d_recorded", "md", &Trajectory::d});
  return signals;
}

/// Returns the values of a signal as the methods saw them, row by row.
std::vector<std::string> recorded_cells(const Trajectory& kept, const RecordedSignal& signal) {
  const RowMajorMatrix values = kept.*signal.member;
  std::vector<std::string> list;
  for (const double value : values.reshaped<Eigen::RowMajor>())
    list.push_back(number(value));
  return list;
}

bool all_have_truth(const Campaign& campaign) {
  bool all = true;
  records_of(campaign).each(
      [&all](const ExperimentRecord& record) { all = all && (!record.loop || record.truth); });
  return all;
}

/// Writes one line per sample of each kept loop: the signals as measured and, for each signal that the record
/// shows differently, also the recorded values.
void write_loops(const Campaign& campaign, const Write& write) {
  const bool truth = all_have_truth(campaign);
  std::vector<RecordRow> signals;
  for (RecordTable& table : record_tables(campaign.study, forms_of(campaign)))
    if (table.group == "trajectories" || (table.group == "truth" && truth))
      for (RecordRow& row : table.rows)
        if (!row.dimensions.empty() && row.dimensions.back() == "sample")
          signals.push_back(std::move(row));
  std::vector<std::string> head{"experiment", "sample", "time"};
  for (const RecordRow& signal : signals)
    for (const std::string& heading : headings(campaign, signal, 1))
      head.push_back(csv_field(heading));
  const std::vector<RecordedSignal> recordings = recorded_signals(campaign.study.record);
  for (const RecordedSignal& signal : recordings)
    for (const std::string& name : coordinates(campaign, signal.variables, 0))
      head.push_back(csv_field(fmt::format("{}.{}", signal.name, name)));
  write(line(head));
  const auto samples = static_cast<std::size_t>(campaign.study.simulation.samples);
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (!record.loop)
      return;
    std::vector<std::vector<std::string>> columns;  // of each signal, row by row
    for (const RecordRow& signal : signals)
      columns.push_back(cells(signal, record));
    if (!recordings.empty()) {
      const Trajectory kept = recorded(campaign.study, record.draw.index, record.loop->trajectory);
      for (const RecordedSignal& signal : recordings)
        columns.push_back(recorded_cells(kept, signal));
    }
    for (std::size_t sample = 0; sample < samples; ++sample) {
      std::vector<std::string> row{
          fmt::format("{}", record.draw.index), fmt::format("{}", sample),
          number(static_cast<double>(sample) * campaign.study.controller.sample_time)};
      for (const std::vector<std::string>& column : columns)
        for (std::size_t at = sample; at < column.size(); at += samples)
          row.push_back(column[at]);
      write(line(row));
    }
  });
}

}  // namespace

void write_csv_records(const Campaign& campaign, const std::vector<RecordTable>& tables,
                       const std::string& group, const Write& write) {
  std::vector<RecordRow> rows;
  for (const RecordTable& table : tables)
    if (table.group == group)
      std::copy_if(table.rows.begin(), table.rows.end(), std::back_inserter(rows),
                   [](const RecordRow& row) { return row.use != RowUse::bytes_only; });
  std::vector<std::string> head{"experiment"};
  for (const RecordRow& row : rows)
    for (const std::string& heading : headings(campaign, row, row.dimensions.size()))
      head.push_back(csv_field(heading));
  write(line(head));
  records_of(campaign).each([&](const ExperimentRecord& record) {
    std::vector<std::string> fields{fmt::format("{}", record.draw.index)};
    for (const RecordRow& row : rows)
      append(cells(row, record), fields);
    write(line(fields));
  });
}

std::vector<std::string> csv_table_names(const Campaign& campaign) {
  std::vector<std::string> names{kExperiments, kFindings, kLoops};
  append(method_names(campaign), names);
  return names;
}

void write_csv_table(const Campaign& campaign, const std::string& name, const Write& write) {
  const auto records = [&](const std::string& group) {
    write_csv_records(campaign, record_tables(campaign.study, forms_of(campaign)), group, write);
  };
  if (name == kExperiments)
    return records("");
  if (name == kFindings)
    return write_findings(campaign, write);
  if (name == kLoops)
    return write_loops(campaign, write);
  const std::vector<std::string> methods = method_names(campaign);
  if (std::find(methods.begin(), methods.end(), name) == methods.end())
    throw InputError("--table", fmt::format("'{}'", name),
                     fmt::format("{}", fmt::join(csv_table_names(campaign), ", ")));
  records("methods/" + name);
}

std::string csv_table(const Campaign& campaign, const std::string& name) {
  std::string text;
  write_csv_table(campaign, name, [&text](std::string_view piece) { text += piece; });
  return text;
}

}  // namespace mpm
