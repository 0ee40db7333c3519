#include "plants/nonlinear/nonlinear_plant.hpp"

#include <utility>

#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/foreign_plant.hpp"

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

}  // namespace mpm
