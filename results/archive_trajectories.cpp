#include <algorithm>

#include <fmt/format.h>

#include "results/archive_error.hpp"
#include "results/archive_groups.hpp"
#include "results/column_io.hpp"
#include "results/dimensions.hpp"
#include "results/matrix_io.hpp"

namespace mpm {
namespace {

constexpr const char* kGroup = "trajectories";
const std::vector<std::string> kAlong{"stored"};

template <class Loops>
auto trajectories_of(Loops& loops) {
  std::vector<decltype(&loops.front()->trajectory)> result;
  for (auto* loop : loops)
    result.push_back(&loop->trajectory);
  return result;
}

}  // namespace

void write_trajectories(Hdf5Group& root, const Campaign& campaign) {
  std::vector<std::int64_t> index;
  std::vector<const LoopRecord*> loops;
  for (const ExperimentRecord& record : campaign.records)
    if (record.loop) {
      index.push_back(record.draw.index);
      loops.push_back(&*record.loop);
    }
  if (loops.empty())
    return;
  const Study& study = campaign.study;
  Hdf5Group group = root.create_group(kGroup);
  group.write_dimension("stored", index,
                        attributes<std::int64_t>({"stored", "index of the experiment whose loop was kept"}));
  write_plant_dimensions(group, study.plant);
  write_sample_dimension(group, "sample", "sample", study, 0, study.simulation.samples);
  const auto trajectories = trajectories_of(loops);
  write_columns(group, kAlong, loop_columns(), trajectories);
  std::vector<const SolverStatistics*> solvers;
  for (const Trajectory* trajectory : trajectories)
    solvers.push_back(&trajectory->solver);
  write_columns(group, kAlong, solver_columns(), solvers);
  for (const SignalColumn& signal : signal_columns(study)) {
    std::vector<const Eigen::MatrixXd*> matrices;
    for (const Trajectory* trajectory : trajectories)
      matrices.push_back(&(trajectory->*signal.member));
    write_matrices(group, {"stored", signal.rows, "sample"}, signal.text, matrices, matrices.front()->rows(),
                   matrices.front()->cols());
  }
  std::vector<const Eigen::MatrixXd*> y_sim;
  for (const LoopRecord* loop : loops)
    y_sim.push_back(&loop->y_sim);
  write_matrices(group, {"stored", "cv", "sample"},
                 {"y_sim", "output of the nominal model, G0 (u, d)", common_unit(study.plant.cvs)}, y_sim,
                 study.cv_count(), study.simulation.samples);
}

void read_trajectories(const Hdf5Group& root, const Study& study, std::vector<ExperimentRecord>& records,
                       const std::string& file) {
  if (!root.has_group(kGroup))
    return;
  const Hdf5Group group = root.group(kGroup);
  std::vector<LoopRecord*> loops;
  for (const std::int64_t index : group.read_list<std::int64_t>("stored")) {
    const auto record = std::find_if(records.begin(), records.end(),
                                     [&](const ExperimentRecord& r) { return r.draw.index == index; });
    if (record == records.end())
      throw ArchiveError(fmt::format(
          "{}: variable 'trajectories/stored': found {}; allowed: an index in 'experiment'", file, index));
    loops.push_back(&record->loop.emplace());
  }
  const auto trajectories = trajectories_of(loops);
  const std::vector<std::size_t> shape{loops.size()};
  read_columns(group, shape, loop_columns(), trajectories, file);
  std::vector<SolverStatistics*> solvers;
  for (Trajectory* trajectory : trajectories)
    solvers.push_back(&trajectory->solver);
  read_columns(group, shape, solver_columns(), solvers, file);
  for (const SignalColumn& signal : signal_columns(study)) {
    const Eigen::Index rows = signal.rows == "cv"   ? study.cv_count()
                              : signal.rows == "mv" ? study.mv_count()
                                                    : study.md_count();
    std::vector<Eigen::MatrixXd*> matrices;
    for (Trajectory* trajectory : trajectories)
      matrices.push_back(&(trajectory->*signal.member));
    read_matrices(group, signal.text.name, true, matrices, rows, study.simulation.samples);
  }
  std::vector<Eigen::MatrixXd*> y_sim;
  for (LoopRecord* loop : loops)
    y_sim.push_back(&loop->y_sim);
  read_matrices(group, "y_sim", true, y_sim, study.cv_count(), study.simulation.samples);
}

}  // namespace mpm
