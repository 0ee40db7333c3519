#pragma once

#include <string>
#include <vector>

#include "plants/plant_model.hpp"

namespace mpm {

/// The benchmark plant of this name. Errors: InputError for an unknown name; the text lists the known ones.
PlantModel benchmark_plant(const std::string& name);

/// The names that benchmark_plant() knows, in the order of the catalogue.
std::vector<std::string> benchmark_plant_names();

}  // namespace mpm
