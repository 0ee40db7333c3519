#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "analysis/methods/assessment_method.hpp"

namespace mpm {

/// {"name", "title", "verdict", "needs": {...}, "answers": {...}, "stated_false_alarms",
/// "origin"}: a method for programs.
nlohmann::ordered_json method_json(const MethodDescription& method);

/// The same with "numbers": [{"name", "scope", "meaning", "unit", "words", "summarised", "label",
/// "estimates_ivar_basis"}], as text.
std::string method_description_json(const MethodDescription& method);

/// The description again. Throws ArchiveError for a text that is none; `file` is for its message.
MethodDescription method_description(const std::string& json, const std::string& file);

}  // namespace mpm
