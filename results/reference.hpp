#pragma once

#include <string>

#include "scenarios/study.hpp"

namespace mpm {

/// The number that the study's reference reports for this aggregate; NaN when there is none.
double reference_value(const Study& study, const std::string& name);

}  // namespace mpm
