#include "plants/nonlinear/quadruple_tank_parameters.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace mpm {
namespace {

struct ParameterSet {
  std::string_view name;
  QuadrupleTankParameters parameters;
};

constexpr std::array kSets{
    ParameterSet{"table-2.6",
                 {.area = {28, 32, 28, 32},
                  .discharge = {3.145, 2.525, 3.145, 2.525},
                  .exponent = {0.5, 0.5, 0.5, 0.5},
                  .pump = {3.14, 3.29}}},
    ParameterSet{"table-3.1",
                 {.area = {28, 28, 32, 32},
                  .discharge = {3.145, 2.525, 3.145, 2.525},
                  .exponent = {0.5, 0.5, 0.5, 0.5},
                  .pump = {3.33, 3.35}}},
};

constexpr double kLargestExponent = 2.0;  // below it, the outflow law of a nearly empty tank holds

// The groups of parameters with the names of their members.
struct Group {
  std::string_view prefix;
  std::span<double> values;
  double limit;
};

std::array<Group, 4> groups(QuadrupleTankParameters& p) {
  return {{{"A", p.area, INFINITY},
           {"cd", p.discharge, INFINITY},
           {"exp", p.exponent, kLargestExponent},
           {"k", p.pump, INFINITY}}};
}

}  // namespace

void QuadrupleTankParameters::validate() const {
  QuadrupleTankParameters copy = *this;
  for (const Group& group : groups(copy))
    for (std::size_t i = 0; i < group.values.size(); ++i)
      if (!(group.values[i] > 0 && group.values[i] < group.limit))
        throw InputError(fmt::format("{}{} of the quadruple tank", group.prefix, i + 1),
                         fmt::to_string(group.values[i]),
                         std::isinf(group.limit) ? "> 0" : fmt::format("above 0 and below {}", group.limit));
}

QuadrupleTankParameters quadruple_tank_parameters(const std::string& name) {
  for (const ParameterSet& set : kSets)
    if (set.name == name)
      return set.parameters;
  throw InputError("parameter set of the quadruple tank", fmt::format("\"{}\"", name),
                   fmt::format("{}", fmt::join(quadruple_tank_parameter_sets(), ", ")));
}

std::vector<std::string> quadruple_tank_parameter_sets() {
  std::vector<std::string> names;
  for (const ParameterSet& set : kSets)
    names.emplace_back(set.name);
  return names;
}

std::vector<std::pair<std::string, double>> named_parameters(const QuadrupleTankParameters& parameters) {
  QuadrupleTankParameters copy = parameters;
  std::vector<std::pair<std::string, double>> named;
  for (const Group& group : groups(copy))
    for (std::size_t i = 0; i < group.values.size(); ++i)
      named.emplace_back(fmt::format("{}{}", group.prefix, i + 1), group.values[i]);
  return named;
}

QuadrupleTankParameters with_parameter(const QuadrupleTankParameters& parameters, const std::string& name,
                                       double value) {
  QuadrupleTankParameters result = parameters;
  std::vector<std::string> known;
  for (const Group& group : groups(result))
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      known.push_back(fmt::format("{}{}", group.prefix, i + 1));
      if (known.back() == name) {
        group.values[i] = value;
        result.validate();
        return result;
      }
    }
  throw InputError("parameter of the quadruple tank", fmt::format("\"{}\"", name),
                   fmt::format("{}", fmt::join(known, ", ")));
}

}  // namespace mpm
