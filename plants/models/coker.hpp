#pragma once

#include "plants/linear/plant_model.hpp"

namespace mpm {

/// A surrogate of the fractionating column of a delayed coking unit, chapter 7 of the thesis ("coker-12x7"):
/// 12 CVs, 7 MVs, 2 measured disturbances, times in minutes. Data and models of the plant are not published;
/// the information in the chapter is kept, everything else is invented.
///
/// | what the chapter says                               | here                                |
/// |-----------------------------------------------------|-------------------------------------|
/// | MV2, MV4 free, CV11 and CV12 at their upper limits  | MV2 drives CV11, MV4 drives CV12    |
/// | CV11 reaches all CVs but CV6, CV7 and CV9 (7.7)     | MV2 drives CV1 to CV5, CV8, CV10    |
/// | CV12 reaches CV1 to CV4 and CV6 (7.7)               | MV4 drives these, and not CV11      |
/// | there is a model of CV11 against MV5 (7.3)          | MV5 drives CV11                     |
/// | DVs are exchange and preparation of the coke drums  | DV1 acts on CV11, DV2 on CV12       |
///
/// Variables have no names in the chapter; they are deviations in percent of a span. Gains are 0.3 to 1.6,
/// time constants 15 to 60 min, dead times 5 to 20 min, and the slowest channels are of second order.
PlantModel coker_12x7();

}  // namespace mpm
