#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/explained_errors.hpp"
#include "analysis/methods/ours/model_errors.hpp"
#include "analysis/methods/ours/whitened_errors.hpp"

// Sensors whose error explains the simulation errors of a record. In a closed loop the model sees what the
// controller did about a wrong measurement, so that the error of a sensor of a CV shows in e of this CV
// alone.

namespace mpm {

/// The error of the sensor of the CV in the place `cv` that explains its simulation errors best,
///
///   e = c + Z' z + n,   c(k) = b from the onset on, or b (k - onset) / (N - 1 - onset),
///
/// a bias or a drift to the end of the record. Onsets on a grid are searched further around the best one.
/// There are two parameters, the size and the onset. A ramp or a step that disturbs the CV looks the same:
/// only a disturbance that wanders can be told from a sensor.
ExplainedErrors best_sensor_error(const std::vector<WhitenedErrors>& errors, std::size_t cv);

/// The gain error in the measurement of an MD that explains the simulation errors of all CVs best, from some
/// onset on. The MD is in the place `input` of the model,
///
///   e_i = G0_ij x + Z_i' z_i + n_i,   x(k) = b d(k),
///
/// with two parameters. `inputs` (nu + nd x N). Nothing is found if the MD moves no CV or does not move.
ExplainedErrors best_md_gain(const std::vector<ModelErrors>& models,
                             const std::vector<WhitenedErrors>& errors,
                             const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index input,
                             double sample_time);

/// Returns whether the measurement of this MD has noise that the MD itself does not have. If so, it moves
/// more from sample to sample in the second half of the record than `healthy_noise` (deviation_of_steps())
/// allows, and the CVs do not follow: d less its median about each sample explains their errors with a size
/// near -1.
bool has_noisy_md(const std::vector<ModelErrors>& models, const std::vector<WhitenedErrors>& errors,
                  const Eigen::Ref<const Eigen::MatrixXd>& inputs, Eigen::Index input, double sample_time,
                  double healthy_noise);

}  // namespace mpm
