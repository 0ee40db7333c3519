#pragma once

#include <string_view>

#include "scenarios/study.hpp"

namespace mpm {

/// What the study says somebody has reported for the aggregate of this name; NaN when it says nothing.
double reference_value(const Study& study, std::string_view name);

}  // namespace mpm
