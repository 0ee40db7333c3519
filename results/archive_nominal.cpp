#include <fmt/format.h>

#include "results/archive_error.hpp"
#include "results/archive_groups.hpp"
#include "results/dimensions.hpp"
#include "results/matrix_io.hpp"

namespace mpm {
namespace {

Flags side_flags() {
  return {{0, 1}, {"lower", "upper"}};
}

}  // namespace

void write_nominal(Hdf5Group& root, const Study& study, const NominalSensitivity& sensitivity) {
  Hdf5Group group = root.create_group("nominal");
  std::vector<PlantModel::Variable> active;
  std::vector<std::int8_t> side;
  std::vector<std::int32_t> position;
  std::vector<const Eigen::MatrixXd*> responses;
  for (std::size_t a = 0; a < sensitivity.active.size(); ++a) {
    const ActiveLimit& limit = sensitivity.active[a];
    active.push_back(study.plant.cvs[static_cast<std::size_t>(limit.cv)]);
    position.push_back(static_cast<std::int32_t>(limit.cv));
    side.push_back(limit.upper ? 1 : 0);
    responses.push_back(&sensitivity.step_response[a]);
  }
  write_variable_dimension(group, "active_cv", "controlled variable with an active soft limit", active);
  write_variable_dimension(group, "cv", "controlled variable", study.plant.cvs);
  write_sample_dimension(group, "lag", "samples after the step", study, 1, study.sensitivity.samples);
  group.write("active_cv_position", {"active_cv"}, position,
              attributes<std::int32_t>({"active_cv_position", "position of the active CV in cv"}));
  group.write("active_side", {"active_cv"}, side,
              attributes<std::int8_t>({"active_side", "which soft limit is active", "1", "", side_flags()}));
  write_matrices(group, {"active_cv", "cv", "lag"},
                 {"t0_step_response", "T0: outputs after a unit step of the active limit; S0 = I - T0"},
                 responses, study.cv_count(), study.sensitivity.samples);
}

NominalSensitivity read_nominal(const Hdf5Group& root, const Study& study, const std::string& file) {
  const Hdf5Group group = root.group("nominal");
  const auto position = group.read_list<std::int32_t>("active_cv_position");
  const auto side = group.read<std::int8_t>("active_side", {position.size()});
  NominalSensitivity sensitivity;
  sensitivity.cv_count = study.cv_count();
  sensitivity.step_response.resize(position.size());
  std::vector<Eigen::MatrixXd*> responses;
  for (std::size_t a = 0; a < position.size(); ++a) {
    if (position[a] < 0 || position[a] >= study.cv_count())
      throw ArchiveError(fmt::format("{}: variable 'nominal/active_cv_position': found {}; allowed: 0 to {}",
                                     file, position[a], study.cv_count() - 1));
    sensitivity.active.push_back({position[a], side[a] != 0});
    responses.push_back(&sensitivity.step_response[a]);
  }
  read_matrices(group, "t0_step_response", true, responses, study.cv_count(), study.sensitivity.samples);
  return sensitivity;
}

}  // namespace mpm
