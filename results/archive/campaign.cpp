#include "results/archive/campaign.hpp"

#include <algorithm>

#include "analysis/methods/thesis/chain_numbers.hpp"

namespace mpm {

AssessmentForms forms_of(const Campaign& campaign) {
  AssessmentForms forms;
  for (const CampaignMethod& method : campaign.methods)
    forms.push_back(method.form);
  return forms;
}

std::vector<std::string> method_names(const Campaign& campaign) {
  std::vector<std::string> names;
  for (const CampaignMethod& method : campaign.methods)
    names.push_back(method.form->method().name);
  return names;
}

void note_command(Campaign& campaign, const std::string& command_line) {
  campaign.info.command = command_line;
  for (CampaignMethod& method : campaign.methods)
    method.command = command_line;
}

std::size_t chain_place(const Campaign& campaign) {
  const auto chain = std::find_if(campaign.methods.begin(), campaign.methods.end(),
                                  [](const CampaignMethod& method) { return diagnoses(*method.form); });
  return static_cast<std::size_t>(chain - campaign.methods.begin());
}

RecordRange records_of(const Campaign& campaign) {
  return campaign.streamed ? *campaign.streamed : RecordRange(campaign.records);
}

StudyRun study_run(const Campaign& campaign, const AssessmentForms& forms) {
  return {campaign.study, forms, records_of(campaign), campaign.calibration};
}

StudyFindings findings_of(const Campaign& campaign) {
  return study_findings(campaign.study, forms_of(campaign), records_of(campaign), campaign.calibration);
}

}  // namespace mpm
