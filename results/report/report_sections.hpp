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
  std::vector<LoopView> loops;  ///< those that can be drawn
  std::int64_t listed_below;    ///< index of the first one without a row in experiments_section()

  const StudyFindings& findings() const { return parts.findings; }
  /// What the chain of the thesis shows of each kind, and where model and plant agree; nothing in a study
  /// that does not run it.
  const std::vector<KindFindings>& kinds() const;
  const std::vector<FalseAlarms>& false_alarms() const;
  /// The loops that are drawn for this reason.
  std::vector<const LoopView*> loops_of(LoopReason reason) const;
  /// The index as words, which lead to the loop of the experiment where it is drawn.
  std::string number_words(std::int64_t index) const;
};

/// Where points lead that stand for this experiment: its row in experiments_section(); empty when it has
/// none.
std::string experiment_anchor(const ReportInput& input, const ExperimentRecord& record);
/// ReportInput::listed_below.
std::int64_t listed_below(const Campaign& campaign);

// Each section, in the order in which a reader asks.

Section run_section(const ReportInput& input);              ///< what was run, and its self-check
Section scenarios_section(const ReportInput& input);        ///< named scenarios (6.11 to 6.13, 6.15)
Section rates_section(const ReportInput& input);            ///< the headline rates
Section loops_section(const ReportInput& input);            ///< a faulty loop and a healthy one
Section experiments_section(const ReportInput& input);      ///< all experiments, a row each
Section false_alarm_section(const ReportInput& input);      ///< verdicts where model and plant agree
Section variance_section(const ReportInput& input);         ///< Ivar_basis against Ivar (6.18, 6.22)
Section location_section(const ReportInput& input);         ///< confusion matrices (6.20, 6.23)
Section indicator_section(const ReportInput& input);        ///< I_MPM by experiment (6.21)
Section dominance_section(const ReportInput& input);        ///< I_MPM against dominance (6.24)
Section roc_section(const ReportInput& input);              ///< I_MPM as a classifier, any threshold
Section fault_size_section(const ReportInput& input);       ///< which small faults are missed
Section sensitivity_section(const ReportInput& input);      ///< T0 (6.10)
Section interaction_section(const ReportInput& input);      ///< RPN and RGA (4.5, 4.6, 4.11, 4.12)
Section s0_perturbation_section(const ReportInput& input);  ///< S0 modified (6.27 to 6.29, 6.32)
Section basis_section(const ReportInput& input);            ///< the basis case (6.8, 6.9)
Section solver_section(const ReportInput& input);           ///< effort and accuracy of the QP solver
Section comparison_section(const ReportInput& input);       ///< methods of assessment, side by side
Section wrong_verdict_section(const ReportInput& input);    ///< wrong verdicts and failures, one by one

/// How many wrong verdicts, and failures, wrong_verdict_section() lists.
inline constexpr std::size_t kMostVerdictRows = 500;

/// The loops behind wrong verdicts, those of them that can be drawn.
void add_wrong_loops(Section& section, const ReportInput& input);

/// Those that the study can have: rates and what belongs to them for random experiments, false alarms after
/// the rates where model and plant agree in some of them, and `scenarios` in their place for named ones;
/// `comparison` where there are several methods. What belongs to the thesis's chain is there when it was run.
/// A later section is a function as above and a line in the list of this one.
std::vector<Section> report_sections(const ReportInput& input);

}  // namespace mpm
