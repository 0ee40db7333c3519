#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "plants/linear/plant_model.hpp"
#include "solvers/mpc_options.hpp"

// The parts of a study that outside programs (methods, controllers) receive, as JSON. A number that is
// missing or not finite is null.

namespace mpm {

nlohmann::ordered_json vector_json(const Eigen::VectorXd& vector);
nlohmann::ordered_json matrix_json(const Eigen::MatrixXd& matrix);  ///< a list of rows
nlohmann::ordered_json limits_json(const Limits& limits);           ///< {"lower": [...], "upper": [...]}

/// Names and units of the variables, the nominal model (transfer functions, and unit step responses of
/// `samples` samples), and the tuning of the controller:
///
///   {"plant", "time_unit", "sample_time", "cvs", "mvs", "mds", "model", "controller"}
nlohmann::ordered_json loop_context_json(const PlantModel& plant, const MpcOptions& controller,
                                         Eigen::Index samples);

}  // namespace mpm
