#include "results/assess/experiment_repair.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/estimate.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "results/assess/repair_form.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/number_json.hpp"
#include "scenarios/loop/historian.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

AssessedLoop loop_of(const Campaign& campaign, const ExperimentRecord& record,
                     const QpSolverFactory& factory) {
  const Study& study = campaign.study;
  const Trajectory trajectory =
      record.loop ? record.loop->trajectory : simulate_experiment(study, record.draw, factory);
  return assessed_loop(study, campaign.basis.point, recorded(study, record.draw.index, trajectory));
}

ExperimentRepair repaired(const Campaign& campaign, const ExperimentRecord& record, const AssessedLoop& loop,
                          const ChannelRepair& repair, const QpSolverFactory& factory) {
  const Study& study = campaign.study;
  return {record.draw, repaired_loop(study, campaign.basis.point, record.draw, loop, repair, factory),
          channel_information(study, loop, repair.channel, study.assessment.model_error)};
}

std::optional<ChannelRepair> chosen_repair(const Campaign& campaign, const ExperimentRecord& record,
                                           const AssessedLoop& loop, const ChannelChoice& choice) {
  const OperatingPoint& point = campaign.basis.point;
  if (choice.asked)
    return identified_channel(campaign.study, point, loop, *choice.asked);
  return channel_repair(campaign.study, point, loop, record.assessments[choice.method]);
}

Json json_of(const Eigen::VectorXd& variances) {
  return std::vector<double>(variances.begin(), variances.end());
}

}  // namespace

bool ChannelChoice::names(const ExperimentRecord& record) const {
  return record.status == ExperimentStatus::ok && record.draw.kind != ExperimentKind::tuning &&
         (asked || channel_to_repair(record.assessments[method]));
}

ChannelChoice choice_of_channel(const Study& study, const std::string& name) {
  std::vector<std::string> known;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
      if (study.plant.G(cv, mv).is_zero())
        continue;
      known.push_back(channel_name(study, {cv, mv}));
      if (known.back() == name)
        return {.asked = Channel{cv, mv}};
    }
  throw InputError("--channel", fmt::format("'{}'", name), fmt::format("{}", fmt::join(known, ", ")));
}

ChannelChoice choice_of_method(const Campaign& campaign, const std::string& name) {
  std::vector<std::string> naming;
  std::optional<std::size_t> first_mismatch, first_channel;
  for (std::size_t m = 0; m < campaign.methods.size(); ++m) {
    const MethodDescription& method = campaign.methods[m].form->method();
    if (!method.names_mismatches && !method.names_channels)
      continue;
    if (method.name == name)
      return {.asked = {}, .method = m};
    naming.push_back(method.name);
    std::optional<std::size_t>& first = method.names_mismatches ? first_mismatch : first_channel;
    if (!first)
      first = m;
  }
  if (name.empty() && (first_mismatch || first_channel))
    return {.asked = {}, .method = first_mismatch ? *first_mismatch : *first_channel};
  throw InputError(
      "--method", name.empty() ? "no method in the archive that names channels" : fmt::format("'{}'", name),
      naming.empty() ? "an archive that such a method has assessed (mpmbench compare --methods), or --channel"
                     : fmt::format("{}", fmt::join(naming, ", ")));
}

std::vector<std::string> ExperimentRepair::worsened(const Study& study) const {
  return worsened_cvs(study, loop.now, loop.predicted, prospect_of(prospects, loop.repair.channel));
}

std::optional<ExperimentRepair> experiment_repair(const Campaign& campaign, const ExperimentRecord& record,
                                                  const ChannelChoice& choice,
                                                  const QpSolverFactory& factory) {
  const AssessedLoop loop = loop_of(campaign, record, factory);
  const std::optional<ChannelRepair> repair = chosen_repair(campaign, record, loop, choice);
  return repair ? std::optional(repaired(campaign, record, loop, *repair, factory)) : std::nullopt;
}

RepairsOfExperiment repairs_of_experiment(const Campaign& campaign, const ExperimentRecord& record,
                                          const ChannelChoice& choice, const QpSolverFactory& factory) {
  const AssessedLoop loop = loop_of(campaign, record, factory);
  const std::optional<ChannelRepair> repair = chosen_repair(campaign, record, loop, choice);
  RepairsOfExperiment repairs{
      .chosen = {},
      .prospects = ranked(RepairProspects(campaign.study, campaign.basis.point, in_turn(factory))
                              .of(loop, repair ? std::optional(repair->repaired()) : std::nullopt)
                              .value_or(std::vector<RepairProspect>{}))};
  if (repair) {
    repairs.chosen = repaired(campaign, record, loop, *repair, factory);
    repairs.chosen->prospects = repairs.prospects;
  }
  return repairs;
}

std::vector<RepairFindings> repair_findings(std::span<const ExperimentRepair> repairs, double confidence) {
  std::vector<RepairOutcome> outcomes;
  for (const ExperimentRepair& repair : repairs)
    if (repair.loop.compares())
      outcomes.push_back({repair.draw.index, target_of(repair.draw, repair.loop.repair.channel),
                          repair.loop.loss_now(), repair.loop.loss_repaired()});
  return repair_findings(std::span<const RepairOutcome>(outcomes), confidence);
}

void require_repairable(const Campaign& campaign, const std::string& archive) {
  if (!campaign.basis.sensitivity.is_known)
    throw InputError(archive, "a controller program that cannot run on its model (on_model is false)",
                     "one that runs on its model: a repaired model is judged by the loops that it promises");
}

std::string repair_text(const Study& study, const ExperimentRepair& repair) {
  const RepairedLoop& loop = repair.loop;
  std::string text =
      fmt::format("channel {}, {}: {}\n", channel_name(study, loop.repair.channel),
                  loop.repair.named ? "corrected by the size that the method names" : "identified again",
                  correction_text(study, loop.repair));
  if (!std::isnan(loop.repair.explained))
    text +=
        fmt::format("{:.0f} % of the error of its CV is explained by it\n", 100.0 * loop.repair.explained);
  text += information_sentence(study, loop.repair.channel, repair.told) + "\n\n";
  Table table("", {{"variance", Table::Align::left}, {"now"}, {"predicted"}, {"repaired"}, {"perfect"}});
  const auto cell = [](const Eigen::VectorXd& variances, Eigen::Index cv) {
    return Number{variances.size() == 0 ? kNaN : variances(cv)};
  };
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    table.row({as_label(cv_name(study, cv)), cell(loop.now, cv), cell(loop.predicted, cv),
               cell(loop.repaired, cv), cell(loop.perfect, cv)});
  const std::vector<std::string> worse = repair.worsened(study);
  const std::string advice =
      worse.empty()
          ? ""
          : fmt::format("Do not put this channel into the controller: {} would vary more with it.\n",
                        fmt::join(worse, ", "));
  return fmt::format(
      "{}{}\n{}now: the controller as it is; predicted: what the repaired model promises, from the record "
      "alone;\n"
      "repaired: with the repaired model on the plant; perfect: with the plant itself as its model\n\n",
      text, table_text(table), advice);
}

Json repair_heading_json(const ExperimentDraw& draw) {
  return {{"index", draw.index}, {"kind", to_string(draw.kind)}};
}

Json repair_json(const Study& study, const ExperimentRepair& repair) {
  Json json = repair_heading_json(repair.draw);
  json["channel"] = channel_name(study, repair.loop.repair.channel);
  json.update(repair_json(repair.loop.repair));
  json["information"] = information_json(repair.told);
  json["worsens"] = repair.worsened(study);
  json["variance"] = {{"now", json_of(repair.loop.now)},
                      {"predicted", json_of(repair.loop.predicted)},
                      {"repaired", json_of(repair.loop.repaired)},
                      {"perfect", json_of(repair.loop.perfect)}};
  return json;
}

std::string repair_findings_text(const std::vector<RepairFindings>& findings) {
  Table table(
      fmt::format(
          "Loss: variance over that of a controller whose model is the plant, mean over the CVs, median of "
          "the loops; better, worse: it changes by more than {:.0f} %.",
          100.0 * (kNoticeableChange - 1.0)),
      {{"repaired", Table::Align::left},
       {"loops"},
       {"better, %"},
       {"worse, %"},
       {"loss now"},
       {"loss repaired"}});
  const auto median = [](const Estimate& estimate) {
    return estimate.count == 0 ? Number{} : fixed(estimate.value, estimate.interval);
  };
  for (const RepairFindings& found : findings)
    table.row({std::string(to_string(found.target)), found.better.total,
               number(found.better, NumberForm::percent), number(found.worse, NumberForm::percent),
               median(found.loss_now), median(found.loss_repaired)});
  return table_text(table);
}

Json repair_findings_json(const std::vector<RepairFindings>& findings) {
  Json json = Json::array();
  for (const RepairFindings& found : findings)
    json.push_back({{"repaired", to_string(found.target)},
                    {"better", rate_json(found.better)},
                    {"worse", rate_json(found.worse)},
                    {"loss_now", estimate_json(found.loss_now)},
                    {"loss_repaired", estimate_json(found.loss_repaired)}});
  return json;
}

}  // namespace mpm
