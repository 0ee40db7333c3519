#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/experiment/repair.hpp"
#include "analysis/findings/repair_findings.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/records/channel_information.hpp"
#include "results/archive/campaign.hpp"
#include "solvers/qp_solver.hpp"

// The repairs that methods ask for in the experiments of a campaign, and their results.

namespace mpm {

/// The channel to repair in an experiment: a given one, or the one that the answer of a method names.
struct ChannelChoice {
  std::optional<Channel> asked;
  std::size_t method = 0;  ///< position in the assessments of a record; used if no channel is given

  /// Tells whether the record ran to its end and there is a channel to repair. If the tuning was changed, the
  /// model needs no repair.
  bool names(const ExperimentRecord& record) const;
};

/// Chooses the channel "CV/MV". Throws InputError("--channel") if there is no such channel.
ChannelChoice choice_of_channel(const Study& study, const std::string& name);

/// Chooses the method `name`. If `name` is empty, chooses the first method of the campaign that names
/// mismatches or, if none does, the first that names channels. Throws InputError("--method") if the method
/// names neither.
ChannelChoice choice_of_method(const Campaign& campaign, const std::string& name);

/// The repair of one experiment.
struct ExperimentRepair {
  ExperimentDraw draw;
  RepairedLoop loop;
  ChannelInformation told;
  std::vector<RepairProspect> prospects = {};  ///< ranked(), of all channels; only in repairs_of_experiment()

  /// Returns the CVs that would vary more with the repair, according to the record alone (worsened_cvs()).
  std::vector<std::string> worsened(const Study& study) const;
};

/// One experiment in full: all channels ranked by what their repair promises, and the chosen repair.
struct RepairsOfExperiment {
  std::optional<ExperimentRepair> chosen;  ///< none: the method names no channel
  std::vector<RepairProspect> prospects;   ///< ranked()
};

/// Repairs the chosen channel of the record; none if the method names no channel in it. Throws InputError as
/// fit_channel().
std::optional<ExperimentRepair> experiment_repair(const Campaign& campaign, const ExperimentRecord& record,
                                                  const ChannelChoice& choice,
                                                  const QpSolverFactory& factory);

/// Repairs the chosen channel and ranks all channels.
RepairsOfExperiment repairs_of_experiment(const Campaign& campaign, const ExperimentRecord& record,
                                          const ChannelChoice& choice, const QpSolverFactory& factory);

/// Summarises the repairs whose loops can be compared.
std::vector<RepairFindings> repair_findings(std::span<const ExperimentRepair> repairs, double confidence);

/// Throws InputError(`archive`) if the controller of the campaign cannot run on its model: a repaired model
/// is judged by the loops that it promises.
void require_repairable(const Campaign& campaign, const std::string& archive);

/// Describes a repair in full, with the variances `now`, `predicted`, `repaired` and `perfect`
/// (RepairedLoop).
std::string repair_text(const Study& study, const ExperimentRepair& repair);
nlohmann::ordered_json repair_json(const Study& study, const ExperimentRepair& repair);
/// Returns index and kind of an experiment, also of one without a repair.
nlohmann::ordered_json repair_heading_json(const ExperimentDraw& draw);

std::string repair_findings_text(const std::vector<RepairFindings>& findings);
nlohmann::ordered_json repair_findings_json(const std::vector<RepairFindings>& findings);

}  // namespace mpm
