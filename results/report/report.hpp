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

/// The reason why the page draws a loop.
enum class LoopReason {
  faulty,   ///< with a fault and a right verdict, the median of its kind by the cost of the fault
  healthy,  ///< the same without a fault
  wrong,    ///< with a wrong verdict, among the costliest
};

/// An experiment whose loop the page draws.
struct ShownExperiment {
  LoopReason reason;
  ExperimentRecord record;
};

/// A closed loop of an experiment, for the page to draw.
struct LoopView {
  ShownExperiment of;
  Trajectory trajectory;
  NominalOutputs nominal;  ///< y0 and its parts, shapes as the trajectory
};

/// The experiments whose loops the page draws, in this order: one that is faulty, one that is healthy, and
/// the costliest with a wrong verdict, the costliest one first. None of named scenarios, which have figures
/// of their own, and none where the chain of the thesis was not asked.
std::vector<ShownExperiment> loops_to_show(const Campaign& campaign);

/// The results of a run as one HTML page that needs nothing else: no network, figures as SVG
/// (docs/report.md). `file` is the archive, for the commands that replay experiments; only its name is shown.
/// Of the loops that are not in `loops` the page draws none. The bytes depend on the campaign, the name and
/// the version of gnuplot only.
///
/// Errors: GnuplotError.
std::string report_html(const Campaign& campaign, const StudyFindings& findings,
                        const std::filesystem::path& file, const std::vector<LoopView>& loops);

/// Writes the same figures but those of loops, and the confusion matrices as heat maps, into `folder`, one
/// file a figure, and returns their paths. The folder is made when its parent exists.
///
/// Errors: GnuplotError; ArchiveError when a file cannot be written.
std::vector<std::filesystem::path> write_figures(const Campaign& campaign, const StudyFindings& findings,
                                                 const std::filesystem::path& folder, FigureFormat format);

}  // namespace mpm
