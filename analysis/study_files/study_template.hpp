#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plants/linear/plant_model.hpp"
#include "solvers/mpc_options.hpp"

namespace mpm {

/// What is known of a plant and its controller before a study of it exists.
///
/// | symbol      | meaning                                                        | shape | unit |
/// |-------------|----------------------------------------------------------------|-------|------|
/// | plant       | its model; no channel integrates, one from an MV is not zero   |       |      |
/// | sample_time | of the controller; none: chosen                                |       | time |
/// | ranges      | soft limits; a CV without them is held at a setpoint           | ny    | CV   |
/// | size        | by how much the setpoint of a CV without a range moves         | ny    | CV   |
/// | noise       | of the CVs, standard deviation; empty or 0: a part of the size | ny    | CV   |
/// | mv_hard     | hard limits, infinite where there are none                     | nu    | MV   |
struct StudySketch {
  PlantModel plant;
  std::optional<double> sample_time;
  std::vector<std::optional<std::pair<double, double>>> ranges;
  Eigen::VectorXd size;
  std::vector<double> noise;
  Limits mv_hard;
};

/// A study of this plant as the text of a study file, with a comment above each key. What
/// the sketch leaves open follows from the time constants, dead times and gains of the model and the sizes of
/// its CVs: horizons from the settling time, weights from what a move does to the CVs in parts of their
/// sizes, the excitation, and faults by their effect on the loop. They are a beginning, and the text says so.
///
/// Errors: InputError for a plant that makes none (PlantModel::validate(), an integrating channel, no channel
/// from an MV), ranges that are not finite or empty, sizes and a sample time that are not positive.
std::string study_template(const StudySketch& sketch);

}  // namespace mpm
