#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "plants/linear/plant_model.hpp"

namespace mpm {
namespace {

PlantModel small_plant() {
  return {.name = "small",
          .title = "a small plant",
          .time_unit = "s",
          .cvs = {{"level", "cm", ""}},
          .mvs = {{"valve", "%", ""}},
          .mds = {{"inflow", "l/s", ""}},
          .G = TransferMatrix(1, 2)};
}

template <typename Change>
void check_refused(Change change) {
  PlantModel plant = small_plant();
  change(plant);
  CHECK_THROWS_AS(plant.validate(), InputError);
}

}  // namespace

TEST_CASE("a consistent plant model is accepted", "[plant_model]") {
  CHECK_NOTHROW(small_plant().validate());
  PlantModel without_mds = small_plant();
  without_mds.mds.clear();
  without_mds.G = TransferMatrix(1, 1);
  CHECK_NOTHROW(without_mds.validate());
}

TEST_CASE("an inconsistent plant model is refused", "[plant_model]") {
  check_refused([](PlantModel& p) { p.name.clear(); });
  check_refused([](PlantModel& p) { p.time_unit.clear(); });
  check_refused([](PlantModel& p) {
    p.cvs.clear();
    p.G = TransferMatrix(0, 2);
  });
  check_refused([](PlantModel& p) {
    p.mvs.clear();
    p.G = TransferMatrix(1, 1);
  });
  check_refused([](PlantModel& p) { p.cvs[0].name.clear(); });
  check_refused([](PlantModel& p) { p.mvs[0].name.clear(); });
  check_refused([](PlantModel& p) { p.mds[0].name.clear(); });
  check_refused([](PlantModel& p) { p.mvs[0].name = "level"; });
  check_refused([](PlantModel& p) { p.mds[0].name = "valve"; });
  check_refused([](PlantModel& p) { p.G = TransferMatrix(2, 2); });
  check_refused([](PlantModel& p) { p.G = TransferMatrix(1, 3); });
}

TEST_CASE("two variables of one kind with one name are refused by name", "[plant_model]") {
  PlantModel plant = small_plant();
  plant.cvs.push_back({"level", "cm", "again"});
  plant.G = TransferMatrix(2, 2);
  CHECK_THROWS_WITH(plant.validate(), Catch::Contains("'level' twice"));
}

}  // namespace mpm
