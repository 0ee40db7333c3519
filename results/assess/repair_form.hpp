#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "analysis/experiment/repair.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/records/channel_information.hpp"
#include "results/document/document.hpp"
#include "scenarios/study/study.hpp"

// Texts about repairs, both of a plant record (`assess`) and of an experiment (`repair`).

namespace mpm {

/// "y2/u1"
std::string channel_name(const Study& study, const Channel& channel);

/// Describes the correction: "0.62 (0.55 to 0.7) times the gain, all else as in the model".
std::string correction_text(const Study& study, const ChannelRepair& repair);

/// Returns the CVs whose expected variance rises by more than kNoticeableChange.
std::vector<std::string> worsened_cvs(const Study& study, const RepairProspect& prospect);
/// Returns the CVs whose variance (ny; empty: not known) rises by more than that from `now` to `then`, and
/// those that the prospect of the same repair worsens (null: there is no prospect).
std::vector<std::string> worsened_cvs(const Study& study, const Eigen::VectorXd& now,
                                      const Eigen::VectorXd& then, const RepairProspect* prospect);
/// Says which parameters of a channel the excitation determines, and which it does not.
std::string information_sentence(const Study& study, const Channel& channel, const ChannelInformation& told);

/// Makes a table of the channels by expected gain. `prospects` must be ranked().
Table prospects_table(const Study& study, const std::vector<RepairProspect>& prospects);

/// | key                      | meaning                                                         |
/// |--------------------------|-----------------------------------------------------------------|
/// | parameter                | the one that is wrong; null: the whole channel                  |
/// | size                     | its `value`, `lower`, `upper`, `bound`; null: the whole channel |
/// | estimated_by             | "verdict", or "fit" if the channel was identified again         |
/// | gain_factor, time_factor | `value`, `lower`, `upper`, `bound` against the model            |
/// | dead_time_shift          | the same                                                        |
/// | explained                | ChannelRepair::explained, or null                               |
/// | transfer_function        | corrected channel: `numerator`, `denominator`, `dead_time`      |
nlohmann::ordered_json repair_json(const ChannelRepair& repair);
nlohmann::ordered_json information_json(const ChannelInformation& told);
nlohmann::ordered_json prospects_json(const Study& study, const std::vector<RepairProspect>& prospects);

}  // namespace mpm
