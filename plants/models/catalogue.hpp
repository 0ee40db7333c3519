#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plants/linear/plant_model.hpp"
#include "plants/nonlinear/nonlinear_model.hpp"

namespace mpm {

/// The benchmark plant of this name. Errors: InputError for an unknown name; the text lists the known ones.
PlantModel benchmark_plant(const std::string& name);

/// The nonlinear plant behind the benchmark plant of this name; none if that plant is linear. Errors: as
/// benchmark_plant().
std::optional<NonlinearModel> nonlinear_benchmark_plant(const std::string& name);

/// The names that benchmark_plant() knows, in the order of the catalogue.
std::vector<std::string> benchmark_plant_names();

}  // namespace mpm
