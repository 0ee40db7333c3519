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

// The repairs that methods ask for in the experiments of a campaign, and what they come to.

namespace mpm {

/// What is repaired in an experiment: one channel, or the one that the answer of a method names.
struct ChannelChoice {
  std::optional<Channel> asked;
  std::size_t method = 0;  ///< place in the assessments of a record; where no channel is asked for

  /// The record ran to its end, and there is a channel to repair. Of a changed tuning the model is not to be
  /// repaired.
  bool names(const ExperimentRecord& record) const;
};

/// The channel "CV/MV". Throws InputError("--channel") for another name.
ChannelChoice choice_of_channel(const Study& study, const std::string& name);

/// The method; empty: the first of the campaign that names mismatches or, where none does, channels. Throws
/// InputError("--method") for one that names neither.
ChannelChoice choice_of_method(const Campaign& campaign, const std::string& name);

/// The repair of one experiment.
struct ExperimentRepair {
  ExperimentDraw draw;
  RepairedLoop loop;
  ChannelInformation told;
  std::vector<RepairProspect> prospects = {};  ///< of all channels, ranked(); of one experiment in full

  /// The CVs that would vary more with it, by the record alone (worsened_cvs()).
  std::vector<std::string> worsened(const Study& study) const;
};

/// An experiment in full: its channels by what their repair promises, and the repair that is chosen.
struct RepairsOfExperiment {
  std::optional<ExperimentRepair> chosen;  ///< none: the method names no channel
  std::vector<RepairProspect> prospects;   ///< ranked()
};

/// Repairs the chosen channel of the record; none: the method names no channel in it. Throws InputError as
/// fit_channel().
std::optional<ExperimentRepair> experiment_repair(const Campaign& campaign, const ExperimentRecord& record,
                                                  const ChannelChoice& choice,
                                                  const QpSolverFactory& factory);

/// The same with all channels ranked.
RepairsOfExperiment repairs_of_experiment(const Campaign& campaign, const ExperimentRecord& record,
                                          const ChannelChoice& choice, const QpSolverFactory& factory);

/// Findings over the repairs whose loops compare.
std::vector<RepairFindings> repair_findings(std::span<const ExperimentRepair> repairs, double confidence);

/// Throws InputError(`archive`) for a campaign whose controller runs on no model: a repaired model is judged
/// by the loops that it promises.
void require_repairable(const Campaign& campaign, const std::string& archive);

/// A repair in full, of `now`, `predicted`, `repaired` and `perfect` (RepairedLoop).
std::string repair_text(const Study& study, const ExperimentRepair& repair);
nlohmann::ordered_json repair_json(const Study& study, const ExperimentRepair& repair);
/// Of an experiment without a repair: its index and kind.
nlohmann::ordered_json repair_heading_json(const ExperimentDraw& draw);

std::string repair_findings_text(const std::vector<RepairFindings>& findings);
nlohmann::ordered_json repair_findings_json(const std::vector<RepairFindings>& findings);

}  // namespace mpm
