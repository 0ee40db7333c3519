#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/sensitivity/nominal_output.hpp"
#include "results/archive/campaign.hpp"
#include "results/plot/figure_format.hpp"
#include "scenarios/loop/closed_loop.hpp"

namespace mpm {

/// Why the page draws a loop.
enum class LoopReason {
  faulty,   ///< with a fault and a right verdict: the median by the cost of the fault
  healthy,  ///< the same without a fault
  wrong,    ///< with a wrong verdict, among those with the highest cost
};

/// An experiment whose loop the page draws.
struct ShownExperiment {
  LoopReason reason;
  ExperimentRecord record;
};

/// A closed loop of an experiment that the page can draw.
struct LoopView {
  ShownExperiment of;
  Trajectory trajectory;
  NominalOutputs nominal;  ///< y0 and its parts, with the shape of the trajectory
};

/// Returns the experiments whose loops the page draws, in this order: a faulty one, a healthy one, and those
/// with a wrong verdict and the highest cost, the highest first. Empty for named scenarios, which have
/// figures of their own, and if the chain of the thesis was not run.
std::vector<ShownExperiment> loops_to_show(const Campaign& campaign);

/// Writes the results of a run as one self-contained HTML page: no network, figures as SVG (docs/report.md).
/// `file` is the archive, for the commands that replay experiments; only its name is shown. The page draws
/// only the loops in `loops`. Its bytes depend only on the campaign, the name and the version of gnuplot.
std::string report_html(const Campaign& campaign, const StudyFindings& findings,
                        const std::filesystem::path& file, const std::vector<LoopView>& loops);

/// Writes the same figures, except for the loops, and the confusion matrices as heat maps into `folder`, one
/// file per figure, and returns their paths. Creates the folder if its parent exists.
///
/// Errors: GnuplotError; ArchiveError if a file cannot be written.
std::vector<std::filesystem::path> write_figures(const Campaign& campaign, const StudyFindings& findings,
                                                 const std::filesystem::path& folder, FigureFormat format);

}  // namespace mpm
