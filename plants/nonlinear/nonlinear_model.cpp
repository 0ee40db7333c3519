#include "plants/nonlinear/nonlinear_model.hpp"

#include <tuple>

#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/foreign_plant.hpp"
#include "plants/same_members.hpp"

namespace mpm {
namespace {

auto members(const NonlinearModel& model) {
  const auto& [parameters, inner_inputs, operating_input, make_system, foreign] = model;
  static_cast<void>(make_system);
  return std::make_tuple(parameters, inner_inputs, operating_input,
                         foreign ? foreign->description() : std::string());
}

}  // namespace

void NonlinearModel::check(const std::vector<ParameterChange>& changes) const {
  if (!foreign)
    make_system(changes);
}

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

bool operator==(const NonlinearModel& a, const NonlinearModel& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
