#pragma once

#include "results/archive/campaign.hpp"
#include "results/report/report_sections.hpp"

namespace mpm {

// Parts of the section of named scenarios.

/// Adds heat maps of Ivar and Ivar_diag of every CV (figures 6.12 and 6.13), and TSSE, co_dkts and co_dskn as
/// points (6.11, 6.15). The campaign must have an experiment with a diagnosis.
void add_scenario_figures(Section& section, const Campaign& campaign);

/// Adds a table of co, ce, mean angle and mean diameter ratio, raw and differentiated, of the flagged CVs,
/// and their confidence ellipses at one window length (figures 5.11 and 5.19). Adds nothing if no CV is
/// flagged.
void add_distributions(Section& section, const Campaign& campaign);

/// Adds a table of the verdicts of the autocorrelation functions, and the functions of y, y0 and y0_diag with
/// the band of white noise. There is one figure for the basis case and one per scenario; it shows the flagged
/// CVs, or all CVs if there are only a few.
void add_autocorrelations(Section& section, const Campaign& campaign);

}  // namespace mpm
