#pragma once

#include <nlohmann/json.hpp>

#include "analysis/statistics/estimate.hpp"
#include "analysis/statistics/interval.hpp"

namespace mpm {

// How numbers with an uncertainty stand in every JSON of the program; NaN and infinity are null.

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
