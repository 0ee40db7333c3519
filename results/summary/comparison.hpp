#pragma once

#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// How often each method of the comparison is right, for people; the campaign must have a comparison.
std::string comparison_text(const Campaign& campaign);

/// The same as JSON: an array `methods`, one object a method, and an array `pairs`.
std::string comparison_json(const Campaign& campaign);

}  // namespace mpm
