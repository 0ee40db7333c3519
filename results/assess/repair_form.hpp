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

// The texts about repairs, of a record of a plant (`assess`) and of an experiment (`repair`).

namespace mpm {

/// "y2/u1"
std::string channel_name(const Study& study, const Channel& channel);

/// What is corrected: "0.62 (0.55 to 0.7) times the gain, all else as in the model".
std::string correction_text(const Study& study, const ChannelRepair& repair);

/// The CVs whose expected variance rises by more than kNoticeableChange.
std::vector<std::string> worsened_cvs(const Study& study, const RepairProspect& prospect);
/// Those whose variance (ny; empty: not known) rises by as much from `now` to `then`, and those of the
/// prospect of the same repair; null: it has none.
std::vector<std::string> worsened_cvs(const Study& study, const Eigen::VectorXd& now,
                                      const Eigen::VectorXd& then, const RepairProspect* prospect);
/// Which parameters of a channel the excitation determines, and which it does not.
std::string information_sentence(const Study& study, const Channel& channel, const ChannelInformation& told);

/// Channels by expected gain, as ranked() has them.
Table prospects_table(const Study& study, const std::vector<RepairProspect>& prospects);

/// | key | meaning |
/// |---|---|
/// | parameter, size | the one that is wrong, with `value`, `lower`, `upper`, `bound`; null: the whole
/// channel | | gain_factor, time_factor, dead_time_shift | the same against the model | | estimated_by |
/// "verdict", or "fit" of a channel that was identified again | | transfer_function | of the corrected
/// channel: `numerator`, `denominator`, `dead_time` | | explained | ChannelRepair::explained, or null |
nlohmann::ordered_json repair_json(const ChannelRepair& repair);
nlohmann::ordered_json information_json(const ChannelInformation& told);
nlohmann::ordered_json prospects_json(const Study& study, const std::vector<RepairProspect>& prospects);

}  // namespace mpm
