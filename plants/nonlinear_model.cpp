#include "plants/nonlinear_model.hpp"

#include "plants/deviation_plant.hpp"

namespace mpm {

std::unique_ptr<Plant> nonlinear_plant(const NonlinearModel& model, double sample_time,
                                       const OdeOptions& options,
                                       const std::vector<ParameterChange>& changes) {
  std::shared_ptr<const OdeSystem> at_rest = model.make_system({});
  auto plant = std::make_unique<OdePlant>(changes.empty() ? at_rest : model.make_system(changes), sample_time,
                                          options, at_rest);
  return std::make_unique<DeviationPlant>(std::move(plant), model.operating_input);
}

}  // namespace mpm
