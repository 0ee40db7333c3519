#include "plants/nonlinear/nonlinear_model.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/same_members.hpp"
#include "plants/nonlinear/deviation_plant.hpp"
#include "plants/nonlinear/foreign_plant.hpp"

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

NonlinearModel with_parameters(NonlinearModel model, const std::vector<ParameterChange>& changes) {
  if (changes.empty())
    return model;
  model.check(changes);
  for (NonlinearModel::Parameter& parameter : model.parameters)
    for (const ParameterChange& change : changes)
      if (change.name == parameter.name)
        parameter.nominal = change.value;
  if (model.make_system)
    model.make_system = [make = model.make_system, changes](std::vector<ParameterChange> later) {
      for (const ParameterChange& change : changes)
        if (std::none_of(later.begin(), later.end(),
                         [&change](const ParameterChange& other) { return other.name == change.name; }))
          later.push_back(change);
      return make(later);
    };
  return model;
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
