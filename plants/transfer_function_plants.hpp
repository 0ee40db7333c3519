#pragma once

#include "plants/plant_model.hpp"

// The benchmark plants that are given by a table of transfer functions.

namespace mpm {

/// The Shell heavy oil fractionator, 7 CVs x 3 MVs x 2 MDs ("shell-7x3"): thesis, eq. 6.18 and table 6.1,
/// after Prett and Morari (1987) and Maciejowski (2002).
///
/// Every channel is gain e^{-dead_time s} / (time_constant s + 1), times in minutes. The variables are
/// deviations without a stated unit. The dead time of channel (y4, u2), printed without its s in eq. 6.18, is
/// 12 min.
PlantModel shell_fractionator_7x3();

/// P2, the 3 x 3 part that chapters 2, 4 and 5 control by setpoints: eq. 2.25 and 4.18, times in minutes. Its
/// y3 is the y7 of eq. 6.18, with a dead time of 19 min from u3 in the place of none.
PlantModel shell_fractionator_3x3();

/// P8, a high-purity binary distillation column in LV configuration (Skogestad & Postlethwaite), eq. 4.15:
///
///                1      [  87.8   -86.4 ]
///   [yD; xB] = -------- [ 108.2  -109.6 ] [L; V],   time in minutes.
///              75 s + 1
///
/// Its condition number is 142 at every frequency and its relative gain 35: hardly two outputs.
PlantModel distillation_column();

/// P9, the model of the SISO case study (5.3.1, table 5.1), with an inverse response; time in seconds:
///
///           -100 s + 3.04
///   G0 = --------------------.
///        305 s^2 + 40 s + 1
///
/// The plant with mismatch of table 5.2 has 18.25 in the place of 3.04.
PlantModel siso_plant();

}  // namespace mpm
