#pragma once

#include <filesystem>
#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// The changes from one run to another as one HTML page that needs nothing else (docs/report.md):
/// experiment by experiment where both ran the same ones, otherwise as unrelated runs, with the reason. The
/// files are their archives, for the commands that replay experiments; their names are shown, or the paths as
/// they are given when the names are the same. The bytes depend on the campaigns, these names and the version
/// of gnuplot only.
///
/// Errors: GnuplotError; InputError for a study that is not what its source says.
std::string change_html(const Campaign& before, const std::filesystem::path& before_file, const Campaign& now,
                        const std::filesystem::path& now_file);

}  // namespace mpm
