#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

// How JSON of the program is written, and how numbers with an uncertainty stand in it; NaN and infinity are
// null.

/// JSON as it is written. Texts of others may hold bytes that are no UTF-8: U+FFFD stands there.
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
