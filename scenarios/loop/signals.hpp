#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/random/random_stream.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/mpc_options.hpp"

namespace mpm {

/// The stream of experiment `index` of the study; the basis case has kBasisIndex.
RandomStream experiment_stream(const Study& study, std::int64_t index, StreamId id);

/// The measured disturbances, nd x samples: the same in every experiment of a study, as in figure 6.17.
/// Steps, and the variation md_noise, which starts with its stationary variance: v(k) = exp(-Ts/tau) v(k-1) +
/// white noise. They are made of the random numbers of experiment `index` (with_excitation()).
Eigen::MatrixXd measured_disturbances(const Study& study, std::int64_t index = kBasisIndex);

/// The setpoints, ny x samples: the same in every experiment of a study; zero for CVs without a setpoint.
/// Empty (0 x 0) when no CV has one.
Eigen::MatrixXd setpoints(const Study& study);

/// The test signals that are added to the MVs, nu x samples: the same in every experiment of a study and
/// under every seed. Empty (0 x 0) when no MV has one.
Eigen::MatrixXd dither(const Study& study);

/// The soft limits of the CVs from sample k on: those of the controller, moved by the limit steps up to k; a
/// CV that is off has none.
Limits soft_limits(const Study& study, Eigen::Index k);

/// The measurement noise of the experiment for a noise factor of 1 (NoiseOptions), ny x samples: white and
/// normal, unless the study asks for another distribution or for an autocorrelation.
Eigen::MatrixXd measurement_noise(const Study& study, std::int64_t index);

/// The signal v of a disturbance, one value a sample. `white` gives the random numbers of a random signal,
/// and `standard_deviation` is the standard deviation of its normal numbers for a factor of 1.
Eigen::RowVectorXd disturbance_signal(const DisturbanceSignal& signal, double standard_deviation,
                                      double sample_time, Eigen::Index samples, RandomStream white);

/// y_d of `disturbance` as if it were the first one of experiment `index`, from the start of the record on;
/// 1 x samples.
Eigen::RowVectorXd disturbance_output(const Study& study, std::int64_t index, const Disturbance& disturbance);

/// The unmeasured disturbances of the experiment on every CV, ny x samples: the sum of y_d = G_d (a v), each
/// from rest with v held over a sample (figure 6.1c), or of y_d = a v for a disturbance without G_d; a(k) is
/// Onset::share(). Zero if the experiment has none.
Eigen::MatrixXd unmeasured_disturbances(const Study& study, const ExperimentDraw& draw);

/// The same on the MVs between controller and plant, nu x samples. Empty (0 x 0) where there are none.
Eigen::MatrixXd disturbances_of_mvs(const Study& study, const ExperimentDraw& draw);

/// The same on the CVs at the times of the rows of the record (record_rows): the exact response y_d = G_d v
/// or its mean; for a signal without G_d, the straight lines between its samples.
Eigen::MatrixXd unmeasured_disturbances_of_rows(const Study& study, const ExperimentDraw& draw);

/// The error of a sensor with a bias or a drift in the measurements, ny x samples; empty (0 x 0) without one.
/// A drift grows from 0 at the onset to its size at the last sample.
Eigen::MatrixXd sensor_errors(const Study& study, const ExperimentDraw& draw);

/// The MDs as they are measured, nd x samples, if the experiment has a wrong measurement of an MD; otherwise
/// empty (0 x 0).
Eigen::MatrixXd measurements_of_mds(const Study& study, const ExperimentDraw& draw);

/// The unmeasured disturbances on the inner inputs of the nonlinear plant, one row an inner input, each held
/// over a sample. Empty (0 x 0) where the plant is linear.
Eigen::MatrixXd disturbances_within_plant(const Study& study, const ExperimentDraw& draw);

}  // namespace mpm
