#pragma once

#include <string>

namespace mpm {

/// The script of a page (page_script.js). It sorts and filters tables, leads from points to their experiments
/// (a touch selects the nearest point, because points are smaller than fingers), and shows a dark page on
/// request. A page is complete without it.
extern const char* const kPageScript;

/// Returns the source expression of a policy that allows only this script: 'sha256-...'.
std::string page_script_policy();

}  // namespace mpm
