#include <utility>

#include "results/archive_groups.hpp"
#include "results/column_io.hpp"
#include "results/dimensions.hpp"
#include "results/matrix_io.hpp"

namespace mpm {
namespace {

const std::vector<std::string> kAlong{"experiment"};

/// Pointers to a part of every record.
template <class Part, class Records, class Get>
std::vector<Part*> parts(Records& records, const Get& get) {
  std::vector<Part*> result;
  result.reserve(records.size());
  for (auto& record : records)
    result.push_back(&get(record));
  return result;
}

}  // namespace

void write_experiments(Hdf5Group& root, const Campaign& campaign) {
  const std::vector<ExperimentRecord>& records = campaign.records;
  std::vector<std::int64_t> index;
  for (const ExperimentRecord& record : records)
    index.push_back(record.draw.index);
  root.write_dimension("experiment", index,
                       attributes<std::int64_t>({"experiment", "index of the experiment in the study"}));
  write_plant_dimensions(root, campaign.study.plant);

  const auto whole = parts<const ExperimentRecord>(
      records, [](const auto& r) -> const auto& { return r; });
  const auto diagnoses = parts<const Diagnosis>(
      records, [](const auto& r) -> const auto& { return r.diagnosis; });
  const auto solvers = parts<const SolverStatistics>(
      records, [](const auto& r) -> const auto& { return r.solver; });
  write_columns(root, kAlong, draw_columns(campaign.study), whole);
  for (const CvColumn<Diagnosis>& column : variance_columns()) {
    std::vector<const Eigen::VectorXd*> vectors;
    for (const Diagnosis* diagnosis : diagnoses)
      vectors.push_back(&(diagnosis->*column.member));
    write_vectors(root, {"experiment", "cv"}, column.text, vectors, campaign.study.cv_count());
  }
  write_columns(root, kAlong, verdict_columns(campaign.study), diagnoses);
  write_columns(root, kAlong, dominance_columns(), whole);
  write_columns(root, kAlong, solver_columns(), solvers);
}

std::vector<ExperimentRecord> read_experiments(const Hdf5Group& root, const Study& study,
                                               const std::string& file) {
  const std::vector<std::int64_t> index = root.read_list<std::int64_t>("experiment");
  std::vector<ExperimentRecord> records(index.size());
  for (std::size_t i = 0; i < index.size(); ++i)
    records[i].draw.index = index[i];

  const std::vector<std::size_t> shape{index.size()};
  const auto whole = parts<ExperimentRecord>(
      records, [](auto& r) -> auto& { return r; });
  const auto diagnoses = parts<Diagnosis>(
      records, [](auto& r) -> auto& { return r.diagnosis; });
  const auto solvers = parts<SolverStatistics>(
      records, [](auto& r) -> auto& { return r.solver; });
  read_columns(root, shape, draw_columns(study), whole, file);
  for (const CvColumn<Diagnosis>& column : variance_columns()) {
    std::vector<Eigen::VectorXd> values =
        read_vectors(root, column.text.name, true, records.size(), study.cv_count());
    for (std::size_t i = 0; i < records.size(); ++i)
      if (records[i].status == ExperimentStatus::ok)
        records[i].diagnosis.*column.member = std::move(values[i]);
  }
  read_columns(root, shape, verdict_columns(study), diagnoses, file);
  read_columns(root, shape, dominance_columns(), whole, file);
  read_columns(root, shape, solver_columns(), solvers, file);
  return records;
}

}  // namespace mpm
