#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "plants/nonlinear/nonlinear_model.hpp"
#include "plants/nonlinear/ode_plant.hpp"
#include "plants/output_sampling.hpp"
#include "plants/plant.hpp"

namespace mpm {

/// The plant of a closed loop, in deviations from the operating point of the nominal plant, with some
/// parameters changed.
///
/// reset() puts it where the nominal plant rests; the parameters change at `onset` (default: the first
/// sample). A plant that had always been different might have no sensible steady state there: with exp3 = 0.1
/// (table 3.9) the third tank would stand at 2370 cm. `options` apply to our own equations. Errors:
/// InputError as OdePlant and `make_system`, or as ForeignPlant.
std::unique_ptr<Plant> nonlinear_plant(const NonlinearModel& model, double sample_time,
                                       const OdeOptions& options, const std::vector<ParameterChange>& changes,
                                       Eigen::Index onset = 0);

/// The same plant as a historian samples it (OdeRecorder): its output i at sample k is the value at the time
/// (k - delay_i) Ts, or the mean over the sample time before that. Errors: as nonlinear_plant(), and
/// InputError for a foreign simulation, which has no outputs between samples.
std::unique_ptr<Plant> nonlinear_recorder(const NonlinearModel& model, double sample_time,
                                          const OdeOptions& options,
                                          const std::vector<ParameterChange>& changes, Eigen::Index onset,
                                          OutputSampling sampling,
                                          const Eigen::Ref<const Eigen::VectorXd>& delay);

}  // namespace mpm
