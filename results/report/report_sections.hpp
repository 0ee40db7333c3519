#pragma once

#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"
#include "results/report/report.hpp"
#include "results/summary/summary_content.hpp"

namespace mpm {

/// What the sections of a report are made from.
struct ReportInput {
  const Campaign& campaign;
  const SummaryContent& parts;
  std::string file;             ///< name of the archive
  std::vector<LoopView> loops;  ///< loops that can be drawn
  std::int64_t listed_below;    ///< index of the first experiment without a row in experiments_section()

  const StudyFindings& findings() const { return parts.findings; }
  /// What the chain of the thesis shows for each kind of fault, and where model and plant agree. Both are
  /// empty if the study does not run the chain.
  const std::vector<KindFindings>& kinds() const;
  const std::vector<FalseAlarms>& false_alarms() const;
  /// Returns the loops that are drawn for this reason.
  std::vector<const LoopView*> loops_of(LoopReason reason) const;
  /// Returns the index as words, with a link to the loop of the experiment if that is drawn.
  std::string number_words(std::int64_t index) const;
};

/// Returns the target of points that stand for this experiment: its row in experiments_section(); empty if it
/// has no row.
std::string experiment_anchor(const ReportInput& input, const ExperimentRecord& record);
/// Computes ReportInput::listed_below.
std::int64_t listed_below(const Campaign& campaign);

// The sections, in the order in which a reader asks.

Section run_section(const ReportInput& input);              ///< what was run, and its self-check
Section scenarios_section(const ReportInput& input);        ///< named scenarios (6.11 to 6.13, 6.15)
Section rates_section(const ReportInput& input);            ///< the headline rates
Section loops_section(const ReportInput& input);            ///< a faulty loop and a healthy one
Section experiments_section(const ReportInput& input);      ///< all experiments, one row each
Section false_alarm_section(const ReportInput& input);      ///< verdicts where model and plant agree
Section variance_section(const ReportInput& input);         ///< Ivar_basis against Ivar (6.18, 6.22)
Section location_section(const ReportInput& input);         ///< confusion matrices (6.20, 6.23)
Section indicator_section(const ReportInput& input);        ///< I_MPM by experiment (6.21)
Section dominance_section(const ReportInput& input);        ///< I_MPM against dominance (6.24)
Section roc_section(const ReportInput& input);              ///< I_MPM as a classifier at any threshold
Section fault_size_section(const ReportInput& input);       ///< which small faults are missed
Section sensitivity_section(const ReportInput& input);      ///< T0 (6.10)
Section interaction_section(const ReportInput& input);      ///< RPN and RGA (4.5, 4.6, 4.11, 4.12)
Section s0_perturbation_section(const ReportInput& input);  ///< S0 modified (6.27 to 6.29, 6.32)
Section basis_section(const ReportInput& input);            ///< the basis case (6.8, 6.9)
Section solver_section(const ReportInput& input);           ///< effort and accuracy of the QP solver
Section comparison_section(const ReportInput& input);       ///< methods of assessment, side by side
Section wrong_verdict_section(const ReportInput& input);    ///< wrong verdicts and failures, one by one

/// wrong_verdict_section() lists at most this many wrong verdicts, and as many failures.
inline constexpr std::size_t kMostVerdictRows = 500;

/// Adds the loops behind wrong verdicts, if they can be drawn.
void add_wrong_loops(Section& section, const ReportInput& input);

/// Returns the sections that the study can have. Random experiments have the rates and what belongs to them,
/// with false alarms after the rates if model and plant agree in some experiments; named scenarios have
/// `scenarios` instead. `comparison` is added if there are several methods. Sections on the thesis's chain
/// are there if it was run. A new section is a function as above and a line in the list of this function.
std::vector<Section> report_sections(const ReportInput& input);

}  // namespace mpm
