#include "plants/siso_plant.hpp"

namespace mpm {

PlantModel siso_plant() {
  return {.name = "siso",
          .title = "SISO plant of second order with an inverse response",
          .time_unit = "s",
          .cvs = {{"y", "1", "Controlled variable"}},
          .mvs = {{"u", "1", "Manipulated variable"}},
          .mds = {},
          .G = {{TransferFunction(Eigen::Vector2d(-100, 3.04), Eigen::Vector3d(305, 40, 1))}}};
}

}  // namespace mpm
