#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "scenarios/faults/fault.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// First-order noise that never stops (BackgroundRanges).
struct BackgroundNoise {
  double standard_deviation = 0.0;
  double pole = 0.0;  ///< a
};

/// The properties of one world of a study, without the faults of an experiment.
///
/// | member         | size   | meaning                                                       |
/// |----------------|--------|---------------------------------------------------------------|
/// | errors         |        | how the channels of the plant differ from the model           |
/// | parameters     |        | values of the parameters of a nonlinear plant                 |
/// | noise_factor   | ny     | factors of the standard deviations of the measurement noise   |
/// | cv_background  | ny     | added to each CV                                              |
/// | mv_background  | nu     | added to each MV on its way to the plant                      |
/// | background_swell |      | BackgroundRanges::swell                                       |
/// | valve_curvature | nu    | of each valve; empty if all are linear                        |
struct World {
  std::vector<Mismatch> errors;
  std::vector<ParameterChange> parameters;
  Eigen::VectorXd noise_factor;
  std::vector<BackgroundNoise> cv_background, mv_background;
  double background_swell = 1.0;
  Eigen::VectorXd valve_curvature = {};
};

/// World `number` of the study, a pure function of (study, seed, number). kExactWorld: nothing differs.
World draw_world(const Study& study, int number);

/// The world in which experiment `index` takes place: the experiments of each kind go to the worlds in turn.
int world_of(const Study& study, std::int64_t index);

/// The plant of a world: the model with its errors.
TransferMatrix world_plant(const Study& study, const World& world);

/// The plant of a world with these mismatches on top of its errors: factors multiply the present values, and
/// a shift never makes a dead time negative.
TransferMatrix with_world_mismatches(TransferMatrix plant, std::vector<Mismatch> mismatches);

/// These changes of parameters, drawn for the nominal plant, on top of the parameters of the world: each
/// keeps its ratio to the value before the change.
std::vector<ParameterChange> with_world_parameters(const Study& study, const World& world,
                                                   std::vector<ParameterChange> changes);

/// The background of the loop of experiment `index`: of the CVs, ny x N, and of the MVs, nu x N; empty where
/// the world has none.
struct Background {
  Eigen::MatrixXd y_d, u_d;
};
Background background(const Study& study, const World& world, std::int64_t index);

}  // namespace mpm
