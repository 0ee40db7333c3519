#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plants/linear/plant_model.hpp"
#include "solvers/mpc_options.hpp"

namespace mpm {

/// The known facts about a plant and its controller, from which study_template() makes a study.
///
/// | symbol      | meaning                                                        | shape | unit |
/// |-------------|----------------------------------------------------------------|-------|------|
/// | plant       | its model; at least one channel from an MV is not zero         |       |      |
/// | sample_time | of the controller (default: chosen)                            |       | time |
/// | ranges      | soft limits; a CV without them has a setpoint                  | ny    | CV   |
/// | size        | size of the setpoint steps of a CV without a range             | ny    | CV   |
/// | noise       | standard deviation; if empty or 0, a fraction of the size      | ny    | CV   |
/// | mv_hard     | hard limits, infinite where there are none                     | nu    | MV   |
struct StudySketch {
  PlantModel plant;
  std::optional<double> sample_time;
  std::vector<std::optional<std::pair<double, double>>> ranges;
  Eigen::VectorXd size;
  std::vector<double> noise;
  Limits mv_hard;
};

/// Returns a study of this plant as the text of a study file, with a comment above each key. Everything that
/// the sketch leaves open follows from the time constants, dead times and gains of the model and the sizes of
/// its CVs: the horizons from the settling time, the weights from the effect of a move on the CVs relative to
/// their sizes, the excitation, and the faults from their effect on the loop. These values are a starting
/// point, and the text says so.
///
/// Errors: InputError for a plant of which no study can be made (PlantModel::validate(), no channel from an
/// MV), for ranges that are empty or not finite, and for sizes or a sample time that are not positive.
std::string study_template(const StudySketch& sketch);

}  // namespace mpm
