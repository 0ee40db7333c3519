#pragma once

#include <optional>
#include <string>

#include "bench/commands/sketch_words.hpp"

namespace mpm {

/// A model as dynamic matrix control has it: a file of columns CV/INPUT, coefficients of the response to a
/// step of 1, and the time between two of them: `interval`, or what a column `time` says. A first row at time
/// 0 is left out. Puts the transfer functions that are fitted to them into the words, and the names of the
/// variables where the words have none: inputs that are no MDs are MVs. Returns what the fits leave, a line a
/// channel. Errors: InputError, which names the file and the column.
std::string take_step_model(SketchWords& words, const std::string& file, std::optional<double> interval);

}  // namespace mpm
