#include "plants/catalogue.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/distillation_column.hpp"
#include "plants/error.hpp"
#include "plants/quadruple_tank.hpp"
#include "plants/shell_fractionator.hpp"
#include "plants/siso_plant.hpp"

namespace mpm {
namespace {

struct CatalogueEntry {
  std::string_view name;
  PlantModel (*make)();
};

constexpr std::array kCatalogue{
    CatalogueEntry{"shell-7x3", shell_fractionator_7x3},
    CatalogueEntry{"shell-3x3", shell_fractionator_3x3},
    CatalogueEntry{"quadruple-tank", quadruple_tank_table_2_6},
    CatalogueEntry{"quadruple-tank-table-3.1", quadruple_tank_table_3_1},
    CatalogueEntry{"distillation-column", distillation_column},
    CatalogueEntry{"siso", siso_plant},
};

}  // namespace

PlantModel benchmark_plant(const std::string& name) {
  for (const CatalogueEntry& entry : kCatalogue) {
    if (entry.name == name) {
      return entry.make();
    }
  }
  throw InputError("benchmark plant", fmt::format("'{}'", name),
                   fmt::format("{}", fmt::join(benchmark_plant_names(), ", ")));
}

std::vector<std::string> benchmark_plant_names() {
  std::vector<std::string> names;
  for (const CatalogueEntry& entry : kCatalogue) {
    names.emplace_back(entry.name);
  }
  return names;
}

}  // namespace mpm
