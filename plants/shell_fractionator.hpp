#pragma once

#include "plants/plant_model.hpp"

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

}  // namespace mpm
