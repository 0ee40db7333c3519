#pragma once

#include <Eigen/Core>

#include "scenarios/draw.hpp"
#include "scenarios/random_stream.hpp"
#include "scenarios/study.hpp"

namespace mpm {

/// The measured disturbances, nd x samples: the same in every experiment of a study, as in figure 6.17.
Eigen::MatrixXd measured_disturbances(const Study& study);

/// The setpoints, ny x samples: the same in every experiment of a study; zero for CVs without a setpoint.
/// Empty (0 x 0) when no CV has one.
Eigen::MatrixXd setpoints(const Study& study);

/// White normal measurement noise of the experiment, ny x samples.
Eigen::MatrixXd measurement_noise(const Study& study, std::int64_t index);

/// The signal v of a disturbance, one value a sample. `white` gives the normal numbers of a white one, and
/// `standard_deviation` is theirs for a factor of 1.
Eigen::RowVectorXd disturbance_signal(const DisturbanceSignal& signal, double standard_deviation,
                                      double sample_time, Eigen::Index samples, RandomStream white);

/// The unmeasured disturbances of the experiment on every CV, ny x samples: the sum of y_d = G_d v, each from
/// rest with v held over a sample (figure 6.1c), or of y_d = v where nothing stands between. Zero where the
/// experiment has none.
Eigen::MatrixXd unmeasured_disturbances(const Study& study, const ExperimentDraw& draw);

/// The unmeasured disturbances on the inner inputs of the nonlinear plant, one row an inner input, each held
/// over a sample. Empty (0 x 0) where the plant is linear.
Eigen::MatrixXd disturbances_within_plant(const Study& study, const ExperimentDraw& draw);

}  // namespace mpm
