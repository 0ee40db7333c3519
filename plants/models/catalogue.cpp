#include "plants/models/catalogue.hpp"

#include <array>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "plants/models/coker.hpp"
#include "plants/models/transfer_function_plants.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"

namespace mpm {
namespace {

struct CatalogueEntry {
  std::string_view name;
  PlantModel (*make)();
  NonlinearModel (*make_nonlinear)() = nullptr;  // null: the plant is linear
};

constexpr std::size_t kNoFlows = 0, kTwoFlows = 2;

constexpr std::array kCatalogue{
    CatalogueEntry{"shell-7x3", shell_fractionator_7x3},
    CatalogueEntry{"shell-3x3", shell_fractionator_3x3},
    CatalogueEntry{"quadruple-tank", quadruple_tank_table_2_6,
                   [] { return quadruple_tank_nonlinear("table-2.6", kNoFlows); }},
    CatalogueEntry{"quadruple-tank-table-3.1", quadruple_tank_table_3_1,
                   [] { return quadruple_tank_nonlinear("table-3.1", kNoFlows); }},
    CatalogueEntry{"quadruple-tank-flows", quadruple_tank_flows_table_2_6,
                   [] { return quadruple_tank_nonlinear("table-2.6", kTwoFlows); }},
    CatalogueEntry{"quadruple-tank-flows-table-3.1", quadruple_tank_flows_table_3_1,
                   [] { return quadruple_tank_nonlinear("table-3.1", kTwoFlows); }},
    CatalogueEntry{"distillation-column", distillation_column},
    CatalogueEntry{"siso", siso_plant},
    CatalogueEntry{"ogunnaike-ray", ogunnaike_ray_column},
    CatalogueEntry{"evaporator", evaporator},
    CatalogueEntry{"column-levels", distillation_column_with_levels},
    CatalogueEntry{"banded-20x8", banded_unit_20x8},
    CatalogueEntry{"coker-12x7", coker_12x7},
};

const CatalogueEntry& entry_of(const std::string& name) {
  for (const CatalogueEntry& entry : kCatalogue) {
    if (entry.name == name) {
      return entry;
    }
  }
  throw InputError("benchmark plant", fmt::format("'{}'", name),
                   fmt::format("{}", fmt::join(benchmark_plant_names(), ", ")));
}

}  // namespace

PlantModel benchmark_plant(const std::string& name) {
  return entry_of(name).make();
}

std::optional<NonlinearModel> nonlinear_benchmark_plant(const std::string& name) {
  const CatalogueEntry& entry = entry_of(name);
  return entry.make_nonlinear == nullptr ? std::nullopt : std::optional(entry.make_nonlinear());
}

std::vector<std::string> benchmark_plant_names() {
  std::vector<std::string> names;
  for (const CatalogueEntry& entry : kCatalogue) {
    names.emplace_back(entry.name);
  }
  return names;
}

}  // namespace mpm
