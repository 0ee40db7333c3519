#pragma once

#include <string>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// What a method needs from a loop, in words: "setpoints that move, a benchmark period"; "nothing else" if
/// records of any loop suffice.
std::string needs_text(const MethodDescription& method);

/// What a method tells about a loop besides its verdict, in words: "the CV, the source"; or "nothing else".
std::string answers_text(const MethodDescription& method);

}  // namespace mpm
