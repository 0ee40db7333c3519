#include "plants/nonlinear/nonlinear_plant.hpp"

#include <utility>

#include "base/error.hpp"
#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/foreign_plant.hpp"
#include "plants/nonlinear/ode_recorder.hpp"

namespace mpm {

std::unique_ptr<Plant> nonlinear_plant(const NonlinearModel& model, double sample_time,
                                       const OdeOptions& options, const std::vector<ParameterChange>& changes,
                                       Eigen::Index onset) {
  if (model.foreign)
    return std::make_unique<ForeignPlant>(model, sample_time, changes, onset);
  std::shared_ptr<const OdeSystem> at_rest = model.make_system({});
  auto plant = std::make_unique<OdePlant>(changes.empty() ? at_rest : model.make_system(changes), sample_time,
                                          options, at_rest, changes.empty() ? 0 : onset);
  return std::make_unique<DeviationPlant>(std::move(plant), model.operating_input);
}

std::unique_ptr<Plant> nonlinear_recorder(const NonlinearModel& model, double sample_time,
                                          const OdeOptions& options,
                                          const std::vector<ParameterChange>& changes, Eigen::Index onset,
                                          OutputSampling sampling,
                                          const Eigen::Ref<const Eigen::VectorXd>& delay) {
  if (model.foreign)
    throw InputError("record of a plant that is a program or an FMU", "values between its samples",
                     "snapshots, off by whole samples");
  const std::shared_ptr<const OdeSystem> at_rest = model.make_system({});
  auto plant =
      std::make_unique<OdeRecorder>(changes.empty() ? at_rest : model.make_system(changes), sample_time,
                                    options, at_rest, changes.empty() ? 0 : onset, sampling, delay);
  return std::make_unique<DeviationPlant>(std::move(plant), model.operating_input);
}

}  // namespace mpm
