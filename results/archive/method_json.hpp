#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// Returns the description of a method for other programs: {"name", "title", "verdict", "needs": {...},
/// "answers": {...}, "stated_false_alarms", "origin"}.
nlohmann::ordered_json method_json(const MethodDescription& method);

/// Returns the same as text, with "numbers": [{"name", "scope", "meaning", "unit", "words", "summarised",
/// "label", "estimates_ivar_basis"}].
std::string method_description_json(const MethodDescription& method);

/// Reads the description back. Throws ArchiveError if the text is no description; `file` is for its message.
MethodDescription method_description(const std::string& json, const std::string& file);

}  // namespace mpm
