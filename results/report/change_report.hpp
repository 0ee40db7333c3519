#pragma once

#include <filesystem>
#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// Writes the changes from one run to another as one self-contained HTML page (docs/report.md). If both ran
/// the same experiments, it compares them one by one; otherwise it compares unrelated runs and gives the
/// reason. `before_file` and `now_file` are the archives, for the commands that replay experiments. The page
/// shows their names, or the paths as given if the names are equal. Its bytes depend only on the campaigns,
/// these names and the version of gnuplot.
///
/// Errors: GnuplotError; InputError if a study differs from its source.
std::string change_html(const Campaign& before, const std::filesystem::path& before_file, const Campaign& now,
                        const std::filesystem::path& now_file);

}  // namespace mpm
