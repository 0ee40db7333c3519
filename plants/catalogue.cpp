#include "plants/catalogue.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "plants/error.hpp"
#include "plants/shell_fractionator.hpp"

namespace mpm {
namespace {

struct CatalogueEntry {
  std::string_view name;
  PlantModel (*make)();
};

constexpr std::array kCatalogue{
    CatalogueEntry{"shell-7x3", shell_fractionator_7x3},
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
