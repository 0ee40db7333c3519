#include "plants/distillation_column.hpp"

namespace mpm {

PlantModel distillation_column() {
  const auto lag = [](double gain) { return TransferFunction::first_order(gain, 75); };
  return {.name = "distillation-column",
          .title = "High-purity distillation column, LV configuration, 2 CVs, 2 MVs",
          .time_unit = "min",
          .cvs = {{"yD", "1", "Composition of the top product"},
                  {"xB", "1", "Composition of the bottom product"}},
          .mvs = {{"L", "1", "Reflux"}, {"V", "1", "Boilup"}},
          .mds = {},
          .G = {{lag(87.8), lag(-86.4)}, {lag(108.2), lag(-109.6)}}};
}

}  // namespace mpm
