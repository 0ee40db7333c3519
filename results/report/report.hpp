#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/plot/figure_format.hpp"

namespace mpm {

/// What a campaign found as one HTML page that needs nothing else: no script, no network, figures as SVG
/// (docs/report.md). `file` is the archive, for the commands that replay experiments; only its name is shown.
/// The bytes depend on the campaign, the name and the version of gnuplot only.
///
/// Errors: GnuplotError.
std::string report_html(const Campaign& campaign, const StudyFindings& findings,
                        const std::filesystem::path& file);

/// Writes the same figures, and the confusion matrices as heat maps, into `folder`, one file a figure, and
/// returns their paths. The folder is made when its parent exists.
///
/// Errors: GnuplotError; ArchiveError when a file cannot be written.
std::vector<std::filesystem::path> write_figures(const Campaign& campaign, const StudyFindings& findings,
                                                 const std::filesystem::path& folder, FigureFormat format);

}  // namespace mpm
