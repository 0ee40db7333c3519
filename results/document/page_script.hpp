#pragma once

#include <string>

namespace mpm {

/// What a page does beyond showing: tables that sort and filter, points that lead to their experiment, a dark
/// page on request. A page without it is complete.
extern const char* const kPageScript;

/// The source of the policy that allows this script and no other: 'sha256-...'.
std::string page_script_policy();

}  // namespace mpm
