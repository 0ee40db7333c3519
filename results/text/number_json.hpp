#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

// How the program writes JSON, and how JSON holds numbers with an uncertainty. NaN and infinity are null.

/// Writes JSON. U+FFFD replaces bytes in foreign texts that are not UTF-8.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = 2) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

inline nlohmann::ordered_json rate_json(const Rate& rate) {
  return {{"hits", rate.hits},
          {"total", rate.total},
          {"value", rate.value},
          {"lower", rate.interval.lower},
          {"upper", rate.interval.upper}};
}

inline nlohmann::ordered_json estimate_json(const Estimate& estimate) {
  return {{"value", estimate.value},
          {"lower", estimate.interval.lower},
          {"upper", estimate.interval.upper},
          {"count", estimate.count}};
}

}  // namespace mpm
