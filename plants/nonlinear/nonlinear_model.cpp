#include "plants/nonlinear/nonlinear_model.hpp"

#include <algorithm>
#include <tuple>

#include "base/same_members.hpp"

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

bool operator==(const NonlinearModel& a, const NonlinearModel& b) {
  return same_members(members(a), members(b));
}

}  // namespace mpm
