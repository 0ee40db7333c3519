#include <cstdint>

#include "results/archive/archive_groups.hpp"
#include "results/archive/column_io.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/matrix_io.hpp"
#include "results/archive/record_subset.hpp"

namespace mpm {
namespace {

constexpr const char* kGroup = "trajectories";

/// Pointers to the trajectories, the solver statistics and the model outputs of loops.
template <class Loop>
struct LoopParts {
  template <class T>
  using Like = std::conditional_t<std::is_const_v<Loop>, const T, T>;

  std::vector<Like<Trajectory>*> trajectories;
  std::vector<Like<SolverStatistics>*> solvers;
  std::vector<Like<Eigen::MatrixXd>*> y_sim;

  void add(Loop& loop) {
    trajectories.push_back(&loop.trajectory);
    solvers.push_back(&loop.trajectory.solver);
    y_sim.push_back(&loop.y_sim);
  }
};

template <class Parts>
auto signals(const Parts& parts, const SignalColumn& column) {
  std::vector<decltype(&(parts.trajectories.front()->*column.member))> pointers;
  for (auto* trajectory : parts.trajectories)
    pointers.push_back(&(trajectory->*column.member));
  return pointers;
}

}  // namespace

void write_trajectories(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  LoopParts<const LoopRecord> parts;
  std::vector<std::int64_t> stored;
  for (const ExperimentRecord& record : campaign.records) {
    if (!record.loop)
      continue;
    stored.push_back(record.draw.index);
    parts.add(*record.loop);
  }
  if (stored.empty())
    return;
  Hdf5Group group = root.create_group(kGroup);
  group.write_attribute("title", "Closed-loop records of the experiments that kept theirs");
  group.write_dimension("stored", stored,
                        attributes<std::int64_t>({"stored", "index of the experiment in the study"}));
  write_plant_dimensions(group, study.plant);
  write_sample_dimension(group, "sample", "sample number", "time", study, 0, study.simulation.samples);
  write_columns(group, {"stored"}, loop_columns(), parts.trajectories);
  write_columns(group, {"stored"}, solver_columns(), parts.solvers);
  for (const SignalColumn& column : signal_columns(study))
    write_matrices(group, {"stored", column.rows, "sample"}, column.text, signals(parts, column),
                   row_count(column, study), study.simulation.samples);
  write_matrices(group, {"stored", "cv", "sample"}, y_sim_text(study), parts.y_sim, study.cv_count(),
                 study.simulation.samples);
}

void read_trajectories(const Hdf5Group& root, const Study& study, std::vector<ExperimentRecord>& records,
                       const std::string& file) {
  if (!root.has_group(kGroup))
    return;
  const Hdf5Group group = root.group(kGroup);
  LoopParts<LoopRecord> parts;
  for (ExperimentRecord* record : records_along(group, kGroup, "stored", records, file))
    parts.add(record->loop.emplace());
  const std::size_t count = parts.trajectories.size();
  read_columns(group, {count}, loop_columns(), parts.trajectories, file);
  read_columns(group, {count}, solver_columns(), parts.solvers, file);
  for (const SignalColumn& column : signal_columns(study))
    read_matrices(group, column.text.name, true, signals(parts, column), row_count(column, study),
                  study.simulation.samples);
  read_matrices(group, "y_sim", true, parts.y_sim, study.cv_count(), study.simulation.samples);
}

}  // namespace mpm
