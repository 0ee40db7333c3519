// The quadruple tank as the nonlinear plant of a study.

#include <memory>

#include <fmt/format.h>

#include "plants/quadruple_tank.hpp"

namespace mpm {

NonlinearModel quadruple_tank_nonlinear(const std::string& set, std::size_t flows) {
  const QuadrupleTankParameters nominal = quadruple_tank_parameters(set);
  NonlinearModel model;
  for (const auto& [name, value] : named_parameters(nominal))
    model.parameters.push_back({name, value});
  for (std::size_t i = flows + 1; i <= std::size_t{QuadrupleTank::kFlows}; ++i)
    model.inner_inputs.push_back(fmt::format("F{}", i));
  for (std::size_t i = 1; i <= std::size_t{QuadrupleTank::kAdded}; ++i)
    model.inner_inputs.push_back(fmt::format("D{}", i));
  model.operating_input = quadruple_tank_operating_point();
  model.make_system = [nominal](const std::vector<ParameterChange>& changes) {
    QuadrupleTankParameters parameters = nominal;
    for (const ParameterChange& change : changes)
      parameters = with_parameter(parameters, change.name, change.value);
    return std::make_shared<const QuadrupleTank>(parameters);
  };
  return model;
}

}  // namespace mpm
