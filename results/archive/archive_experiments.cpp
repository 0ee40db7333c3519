#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/column_io.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/matrix_io.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

/// Pointers to a part of each record, as column_io takes them.
template <class Records, class Part>
auto parts(Records& records, Part part) {
  std::vector<decltype(part(records.front()))> pointers;
  pointers.reserve(records.size());
  for (auto& record : records)
    pointers.push_back(part(record));
  return pointers;
}

template <class Records>
auto experiments_of(Records& records) {
  return parts(records, [](auto& record) { return &record; });
}

template <class Records>
auto diagnoses_of(Records& records) {
  return parts(records, [](auto& record) { return &record.diagnosis; });
}

template <class Records>
auto solvers_of(Records& records) {
  return parts(records, [](auto& record) { return &record.solver; });
}

/// A changed tuning is that of a weight which the controller has.
bool is_possible(const TuningChange& tuning, const MpcOptions& controller) {
  if (tuning.parameter < TuningParameter::move_suppression)
    return false;
  const std::vector<Eigen::Index> variables = variables_with(controller, tuning.parameter);
  return std::find(variables.begin(), variables.end(), tuning.index) != variables.end();
}

/// What the columns cannot see one by one: an experiment with a fault has it somewhere, a fault with a
/// mismatch has a channel and a parameter, a changed tuning a weight, and a verdict names a CV. Everything
/// that counts takes this as given.
void require_consistent(const ExperimentRecord& record, const Study& study, const std::string& file) {
  const auto require = [&](bool condition, const char* variable, const char* allowed) {
    if (!condition)
      throw ArchiveError(fmt::format("{}: variable '{}': found none in experiment {}; allowed: {}", file,
                                     variable, record.draw.index, allowed));
  };
  const ExperimentDraw& draw = record.draw;
  if (!draw.named) {
    require(draw.kind != ExperimentKind::none || study.experiments.healthy > 0, "kind",
            "a kind that the study counts");
    require(is_faultless(draw.kind) || draw.true_cv() >= 0, "true_cv", "the CV of the fault");
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
  if (record.status == ExperimentStatus::ok && record.diagnosis.impactful)
    require(record.diagnosis.predicted_cv >= 0, "predicted_cv", "a CV for an experiment with impact");
}

/// The scenario of a record, whose faults are in the study and in no column.
void take_scenario(ExperimentRecord& record, const Study& study, const std::string& file) {
  if (record.draw.index >= study.experiment_count())
    throw ArchiveError(
        fmt::format("{}: variable 'experiment': found {}; allowed: 0 to {}, the scenarios of "
                    "the study",
                    file, record.draw.index, study.experiment_count() - 1));
  ExperimentDraw draw = draw_experiment(study, record.draw.index);
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

}  // namespace

void write_experiments(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  const std::vector<ExperimentRecord>& records = campaign.records;
  std::vector<std::int64_t> indices;
  for (const ExperimentRecord& record : records)
    indices.push_back(record.draw.index);
  root.write_dimension("experiment", indices,
                       attributes<std::int64_t>({"experiment", "index of the experiment in the study"}));
  write_plant_dimensions(root, study.plant);

  write_columns(root, {"experiment"}, draw_columns(study), experiments_of(records));
  for (const CvColumn<Diagnosis>& column : variance_columns())
    write_vectors(root, {"experiment", "cv"}, column.text,
                  parts(records, [&](const auto& r) { return &(r.diagnosis.*column.member); }),
                  study.cv_count());
  write_columns(root, {"experiment"}, verdict_columns(study), diagnoses_of(records));
  write_columns(root, {"experiment"}, dominance_columns(), experiments_of(records));
  write_columns(root, {"experiment"}, solver_columns(), solvers_of(records));
}

std::vector<ExperimentRecord> read_experiments(const Hdf5Group& root, const Study& study,
                                               const std::string& file) {
  const std::vector<std::int64_t> indices = root.read_list<std::int64_t>("experiment");
  require_order(indices, file);
  const std::size_t count = indices.size();
  std::vector<ExperimentRecord> records(count);
  for (std::size_t i = 0; i < count; ++i)
    records[i].draw.index = indices[i];

  read_columns(root, {count}, draw_columns(study), experiments_of(records), file);
  read_columns(root, {count}, verdict_columns(study), diagnoses_of(records), file);
  read_columns(root, {count}, dominance_columns(), experiments_of(records), file);
  read_columns(root, {count}, solver_columns(), solvers_of(records), file);
  for (const CvColumn<Diagnosis>& column : variance_columns()) {
    const std::vector<Eigen::VectorXd> vectors =
        read_vectors(root, column.text.name, true, count, study.cv_count());
    for (std::size_t i = 0; i < count; ++i)
      if (records[i].status == ExperimentStatus::ok)  // the others have no diagnosis
        records[i].diagnosis.*column.member = vectors[i];
  }
  for (ExperimentRecord& record : records) {
    if (study.names_scenarios())
      take_scenario(record, study, file);
    require_consistent(record, study, file);
  }
  return records;
}

}  // namespace mpm
