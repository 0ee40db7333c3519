#pragma once

#include <string>

namespace mpm {

/// What a page does beyond showing (page_script.js): tables that sort and filter, points that lead to their
/// experiment, the nearest one of a touch since points are smaller than fingers, and a dark page on request.
/// A page without it is complete.
extern const char* const kPageScript;

/// The source of the policy that allows this script and no other: 'sha256-...'.
std::string page_script_policy();

}  // namespace mpm
