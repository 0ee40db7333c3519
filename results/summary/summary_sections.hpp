#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "results/archive/campaign.hpp"
#include "results/document/document.hpp"
#include "results/summary/summary_content.hpp"

// Tables that the summary and the report share.

namespace mpm {

/// What was run, by which program, and whether the basis case is healthy.
Facts run_facts(const Campaign& campaign, const SummaryContent& parts);

/// How far the identified T0 is from the direct one.
std::string identification_words(const Study& study, const BasisCase& basis);
/// Differences between the two solvers on steps that both solved.
std::string audit_words(const SummaryContent& parts, const CampaignInfo& info);

/// The most important findings for people, beside the reported ones if the study has some.
Table findings_table(const Study& study, const StudyFindings& findings);

/// I_MPM of the experiments with both faults, by the dominance of the mismatch.
Table dominance_table(const Study& study, const std::vector<DominanceBin>& bins);

/// The first experiments for which the method that diagnoses gave a wrong verdict. `number` formats an index.
Table wrong_table(const Study& study, const SummaryContent& parts, const std::string& file, std::size_t most,
                  const std::function<std::string(std::int64_t)>& number);
/// The first experiments without a result.
Table failed_table(const Study& study, const SummaryContent& parts, const std::string& file,
                   std::size_t most);

/// Named scenarios: the verdict on each compared with the study.
Table scenario_table(const Campaign& campaign, const std::string& file);
/// Ivar and Ivar_diag of every CV. Values outside the band of impact are marked.
Table index_table(const Campaign& campaign);
/// The indicators of the flagged CVs.
Table indicator_table(const Campaign& campaign);
/// The CVs whose autocorrelation functions differ from those of their nominal outputs.
Table acf_table(const Campaign& campaign);

/// Fits to the diagonal of T0, and the effect of multiplied parameters on Ivar_diag.
Table s0_change_table(const Study& study, const SummaryContent& parts);
/// The fits with MVs fixed, and the multipliers from one fit to the other.
Table s0_structure_table(const Study& study, const SummaryContent& parts);

/// Tells whether `method` is empty or the method that diagnoses: its findings have no method in their names.
bool is_own(const StudyFindings& findings, const std::string& method);
/// "MPM"; for a method other than the one that diagnoses "MPM, counterfactual".
std::string kind_heading(const StudyFindings& findings, ExperimentKind kind, const std::string& method);

/// "u1, u2": the MVs that the study fixes.
std::string fixed_names(const Study& study);

}  // namespace mpm
