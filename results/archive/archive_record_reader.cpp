#include "results/archive/archive_record_reader.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/row_io.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/loop/draw.hpp"

namespace mpm {
namespace {

// Limits of the records in memory at a time: those of one chunk, so that it is read only once, but fewer if
// the loops are long.
constexpr std::size_t kBlockRecords = kChunkValues;
constexpr std::size_t kBlockBytes = std::size_t{1} << 25;

Hdf5Group group_at(const Hdf5Group& root, const std::string& path) {
  const std::size_t slash = path.find('/');
  return path.empty()                 ? root
         : slash == std::string::npos ? root.group(path)
                                      : group_at(root.group(path.substr(0, slash)), path.substr(slash + 1));
}

/// The values of a variable for each of these records, in memory and in the file.
struct Rows {
  std::vector<ExperimentRecord*> records;
  std::size_t first, all;  ///< row of the first record, number of rows in the file

  void read(const Hdf5Group& group, const RecordRow& row, const std::string& file) const {
    std::vector<std::size_t> shape{all};
    shape.insert(shape.end(), row.shape.begin(), row.shape.end());
    std::visit(
        [&]<class T>(const RowAccess<ExperimentRecord, T>& access) {
          const std::vector<T> values = group.read_rows<T>(row.text.name, shape, first, records.size());
          require_words(row.text, values, file);
          const T* place = values.data();
          for (ExperimentRecord* record : records) {
            access.set(*record, place);
            place += row.size();
          }
        },
        row.access);
  }
};

/// Tells whether the controller has the weight that a change of the tuning changes.
bool is_possible(const TuningChange& tuning, const MpcOptions& controller) {
  if (tuning.parameter < TuningParameter::move_suppression)
    return false;
  const std::vector<Eigen::Index> variables = variables_with(controller, tuning.parameter);
  return std::find(variables.begin(), variables.end(), tuning.index) != variables.end();
}

/// Checks what no variable shows alone: an experiment with a fault has a place for it, a mismatch has a
/// channel and a parameter, a changed tuning has a weight, and a verdict names a CV. All code that counts
/// relies on this.
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

/// Tells whether the study says more about its experiments than the variables of an archive do.
bool has_further_draws(const Study& study) {
  return study.names_scenarios() || !study.has_plain_faults();
}

/// Takes the draw of a record from the study, because the variables hold none or only some of its faults. The
/// scales of the draw are in variables.
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

/// Throws ArchiveError unless the indices ascend, each one once.
void require_order(const std::vector<std::int64_t>& indices, const std::string& file) {
  const auto place = std::adjacent_find(indices.begin(), indices.end(), std::greater_equal<>());
  if (place != indices.end())
    throw ArchiveError(
        fmt::format("{}: variable 'experiment': found {} after {}; allowed: indices in ascending order", file,
                    *(place + 1), *place));
  if (!indices.empty() && indices.front() < 0)
    throw ArchiveError(
        fmt::format("{}: variable 'experiment': found {}; allowed: 0 or more", file, indices.front()));
}

/// Returns the places in `indices` of the experiments that a dimension of a group lists.
std::vector<std::size_t> places_along(const Hdf5Group& group, const RecordTable& table,
                                      const std::vector<std::int64_t>& indices, const std::string& file) {
  std::vector<std::size_t> places;
  auto next = indices.begin();
  for (const std::int64_t index : group.read_list<std::int64_t>(table.dimension)) {
    next = std::lower_bound(next, indices.end(), index);
    if (next == indices.end() || *next != index)
      throw ArchiveError(
          fmt::format("{}: dimension '/{}/{}': found {}; allowed: experiments of the root group in their "
                      "order, each once",
                      file, table.group, table.dimension, index));
    places.push_back(static_cast<std::size_t>(next++ - indices.begin()));
  }
  return places;
}

/// Returns about how many bytes a record needs that is in all tables.
std::size_t bytes_of(const std::vector<RecordTable>& tables) {
  std::size_t bytes = sizeof(ExperimentRecord);
  for (const RecordTable& table : tables)
    for (const RecordRow& row : table.rows)
      bytes += row.size() * sizeof(double);
  return bytes;
}

}  // namespace

ArchiveRecordReader::ArchiveRecordReader(const Hdf5Group& root, const Study& study,
                                         const AssessmentForms& forms, std::vector<RecordTable> tables,
                                         std::string file)
    : study_(study),
      file_(std::move(file)),
      indices_(root.read_list<std::int64_t>("experiment")),
      tables_(std::move(tables)),
      milliseconds_(read_method_times(root, forms)) {
  require_order(indices_, file_);
  std::erase_if(tables_, [&root](const RecordTable& table) {
    return table.dimension == "stored" && !root.has_group(table.group);
  });
  block_ = std::clamp<std::size_t>(kBlockBytes / bytes_of(tables_), 1, kBlockRecords);
  for (RecordTable& table : tables_) {
    groups_.push_back(group_at(root, table.group));
    const std::vector<std::string> names = groups_.back().variables();
    std::erase_if(table.rows, [&names](const RecordRow& row) {
      return row.since > 0 && std::find(names.begin(), names.end(), row.text.name) == names.end();
    });
    std::vector<std::size_t> places = places_along(groups_.back(), table, indices_, file_);
    if (table.has)
      places_.push_back(std::move(places));
    else if (places_.emplace_back(); places.size() != indices_.size())
      throw ArchiveError(
          fmt::format("{}: dimension '/{}/{}': found {} experiments; allowed: the {} of the root "
                      "group",
                      file_, table.group, table.dimension, places.size(), indices_.size()));
  }
}

std::vector<ExperimentRecord> ArchiveRecordReader::read(std::size_t first, std::size_t count) const {
  std::vector<ExperimentRecord> records(count);
  for (std::size_t i = 0; i < count; ++i)
    records[i].draw.index = indices_[first + i];
  for (std::size_t t = 0; t < tables_.size(); ++t)
    read_table(t, first, records);
  for (ExperimentRecord& record : records) {
    for (std::size_t m = 0; m < milliseconds_.size(); ++m)
      if (record.assessments[m].answered())
        record.assessments[m].milliseconds = milliseconds_[m];
    if (has_further_draws(study_))
      take_draw(record, study_, file_);
    require_consistent(record, study_, file_);
  }
  return records;
}

void ArchiveRecordReader::read_table(std::size_t t, std::size_t first,
                                     std::vector<ExperimentRecord>& records) const {
  const RecordTable& table = tables_[t];
  Rows rows{{}, first, indices_.size()};
  if (!table.has) {
    for (ExperimentRecord& record : records)
      rows.records.push_back(&record);
  } else {
    const std::vector<std::size_t>& places = places_[t];
    auto place = std::lower_bound(places.begin(), places.end(), first);
    rows.first = static_cast<std::size_t>(place - places.begin());
    rows.all = places.size();
    for (; place != places.end() && *place < first + records.size(); ++place)
      rows.records.push_back(&records[*place - first]);
  }
  if (table.make)
    for (ExperimentRecord* record : rows.records)
      table.make(*record);
  for (const RecordRow& row : table.rows)
    if (row.use == RowUse::everywhere)
      rows.read(groups_[t], row, file_);
}

RecordRange streamed(std::shared_ptr<const ArchiveRecordReader> reader) {
  struct Block {
    std::size_t first = 0, place = 0;  // first: in the file; place: in the block
    std::vector<ExperimentRecord> records = {};
  };
  return {reader->size(),
          [reader]() -> RecordRange::Next {
            return [reader, block = std::make_shared<Block>()]() -> const ExperimentRecord* {
              if (block->place == block->records.size()) {
                *block = {.first = block->first + block->place};  // freed before the next one is read
                const std::size_t left = reader->size() - block->first;
                if (left == 0)
                  return nullptr;
                block->records = reader->read(block->first, std::min(reader->block(), left));
              }
              return &block->records[block->place++];
            };
          },
          [reader](std::size_t place) { return reader->read(place, 1).front(); }};
}

}  // namespace mpm
