#pragma once

#include "plants/plant_model.hpp"

namespace mpm {

/// P8, a high-purity binary distillation column in LV configuration (Skogestad & Postlethwaite), eq. 4.15:
///
///                1      [  87.8   -86.4 ]
///   [yD; xB] = -------- [ 108.2  -109.6 ] [L; V],   time in minutes.
///              75 s + 1
///
/// Its condition number is 142 at every frequency and its relative gain 35: hardly two outputs.
PlantModel distillation_column();

}  // namespace mpm
