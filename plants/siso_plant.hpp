#pragma once

#include "plants/plant_model.hpp"

namespace mpm {

/// P9, the model of the SISO case study (5.3.1, table 5.1), with an inverse response; time in seconds:
///
///           -100 s + 3.04
///   G0 = --------------------.
///        305 s^2 + 40 s + 1
///
/// The plant with mismatch of table 5.2 has 18.25 in the place of 3.04.
PlantModel siso_plant();

}  // namespace mpm
