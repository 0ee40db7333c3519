#include "analysis/experiment/repair.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/findings/repair_findings.hpp"
#include "analysis/methods/ours/repair_prospects.hpp"
#include "analysis/records/channel_information.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
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

struct RepairArguments {
  std::string archive, method, channel;
  std::optional<std::int64_t> index;
  bool json = false;
  bool quiet = false;
};

/// The repair of one experiment.
struct Repair {
  ExperimentDraw draw;
  RepairedLoop loop;
  ChannelInformation told;
  std::vector<RepairProspect> prospects = {};  ///< ranked(); of one experiment in full
};

std::vector<std::string> worsened(const Study& study, const Repair& repair) {
  return worsened_cvs(study, repair.loop.now, repair.loop.predicted,
                      prospect_of(repair.prospects, repair.loop.repair.channel));
}

/// "y2/u1"
Channel channel_of(const Study& study, const std::string& name) {
  std::vector<std::string> known;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv) {
      if (study.plant.G(cv, mv).is_zero())
        continue;
      known.push_back(channel_name(study, {cv, mv}));
      if (known.back() == name)
        return {cv, mv};
    }
  throw InputError("--channel", fmt::format("'{}'", name), fmt::format("{}", fmt::join(known, ", ")));
}

/// Whose word is taken for the channel: the method asked for, or the first of the archive that names
/// mismatches or, where none does, channels.
std::size_t method_of(const Campaign& campaign, const std::string& name) {
  std::vector<std::string> naming;
  std::optional<std::size_t> first_mismatch, first_channel;
  for (std::size_t m = 0; m < campaign.methods.size(); ++m) {
    const MethodDescription& method = campaign.methods[m].form->method();
    if (!method.names_mismatches && !method.names_channels)
      continue;
    if (method.name == name)
      return m;
    naming.push_back(method.name);
    std::optional<std::size_t>& first = method.names_mismatches ? first_mismatch : first_channel;
    if (!first)
      first = m;
  }
  if (name.empty() && (first_mismatch || first_channel))
    return first_mismatch ? *first_mismatch : *first_channel;
  throw InputError(
      "--method", name.empty() ? "no method in the archive that names channels" : fmt::format("'{}'", name),
      naming.empty() ? "an archive that such a method has assessed (mpmbench compare --methods), or --channel"
                     : fmt::format("{}", fmt::join(naming, ", ")));
}

/// What is repaired in an experiment, by the channel that the user asks for or the answer of a method.
struct ChannelChoice {
  std::optional<Channel> asked;
  std::size_t method = 0;  ///< place in the assessments of a record; when no channel is asked for

  bool names(const ExperimentRecord& record) const {
    return asked || channel_to_repair(record.assessments[method]).has_value();
  }
  std::optional<ChannelRepair> of(const Campaign& campaign, const ExperimentRecord& record,
                                  const AssessedLoop& loop) const {
    const OperatingPoint& point = campaign.basis.point;
    if (asked)
      return identified_channel(campaign.study, point, loop, *asked);
    return channel_repair(campaign.study, point, loop, record.assessments[method]);
  }
};

AssessedLoop loop_of(const Campaign& campaign, const ExperimentRecord& record,
                     const QpSolverFactory& factory) {
  const Study& study = campaign.study;
  const Trajectory trajectory =
      record.loop ? record.loop->trajectory : simulate_experiment(study, record.draw, factory);
  return assessed_loop(study, campaign.basis.point, recorded(study, record.draw.index, trajectory));
}

Repair repaired(const Campaign& campaign, const ExperimentRecord& record, const AssessedLoop& loop,
                const ChannelRepair& repair, const QpSolverFactory& factory) {
  const Study& study = campaign.study;
  return {record.draw, repaired_loop(study, campaign.basis.point, record.draw, loop, repair, factory),
          channel_information(study, loop, repair.channel, study.assessment.model_error)};
}

Json json_of(const Eigen::VectorXd& variances) {
  return std::vector<double>(variances.begin(), variances.end());
}

Json heading_json(const ExperimentDraw& draw) {
  return {{"index", draw.index}, {"kind", to_string(draw.kind)}};
}

Json json_of(const Study& study, const Repair& repair) {
  Json json = heading_json(repair.draw);
  json["channel"] = channel_name(study, repair.loop.repair.channel);
  json.update(repair_json(repair.loop.repair));
  json["information"] = information_json(repair.told);
  json["worsens"] = worsened(study, repair);
  json["variance"] = {{"now", json_of(repair.loop.now)},
                      {"predicted", json_of(repair.loop.predicted)},
                      {"repaired", json_of(repair.loop.repaired)},
                      {"perfect", json_of(repair.loop.perfect)}};
  return json;
}

/// One repair in full.
std::string text_of(const Study& study, const Repair& repair) {
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
  const std::vector<std::string> worse = worsened(study, repair);
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

/// The outcomes of all repairs that compare.
std::vector<RepairOutcome> outcomes_of(const std::vector<Repair>& repairs) {
  std::vector<RepairOutcome> outcomes;
  for (const Repair& repair : repairs)
    if (repair.loop.compares())
      outcomes.push_back({repair.draw.index, target_of(repair.draw, repair.loop.repair.channel),
                          repair.loop.loss_now(), repair.loop.loss_repaired()});
  return outcomes;
}

Json json_of(const std::vector<RepairFindings>& findings) {
  Json json = Json::array();
  for (const RepairFindings& found : findings)
    json.push_back({{"repaired", to_string(found.target)},
                    {"better", rate_json(found.better)},
                    {"worse", rate_json(found.worse)},
                    {"loss_now", estimate_json(found.loss_now)},
                    {"loss_repaired", estimate_json(found.loss_repaired)}});
  return json;
}

std::string text_of(const std::vector<RepairFindings>& findings) {
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

ChannelChoice chosen(const Campaign& campaign, const RepairArguments& options) {
  if (options.channel.empty())
    return {.asked = {}, .method = method_of(campaign, options.method)};
  if (!options.index)
    throw InputError("--channel", "no --index", "one channel of one experiment");
  return {.asked = channel_of(campaign.study, options.channel)};
}

void repair_one(const Campaign& campaign, std::int64_t index, const ChannelChoice& choice, bool json) {
  const ExperimentRecord record = experiment_of(campaign, index);
  if (record.status != ExperimentStatus::ok)
    throw InputError("--index", fmt::format("{}, which did not run to its end", index),
                     "an experiment that did");
  const Study& study = campaign.study;
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  const AssessedLoop loop = loop_of(campaign, record, factory);
  const std::optional<ChannelRepair> repair = choice.of(campaign, record, loop);
  const auto prospects = ranked(RepairProspects(study, campaign.basis.point, factory)
                                    .of(loop, repair ? std::optional(repair->repaired()) : std::nullopt)
                                    .value_or(std::vector<RepairProspect>{}));
  std::optional<Repair> done;
  if (repair) {
    done = repaired(campaign, record, loop, *repair, factory);
    done->prospects = prospects;
  }
  if (json) {
    Json all = done ? json_of(study, *done) : heading_json(record.draw);
    all["candidates"] = prospects_json(study, prospects);
    print_result(json_text(all));
    return;
  }
  print_result(fmt::format(
      "{}\n{}{}", experiment_title(study, record.draw),
      done ? text_of(study, *done)
           : fmt::format("{} names no channel\n\n", campaign.methods[choice.method].form->method().name),
      prospects.empty() ? "No channel has an error that shows in the record.\n"
                        : table_text(prospects_table(study, prospects))));
}

/// The repairs of all experiments in which a channel is named; of a changed tuning the model is not to be.
std::vector<Repair> all_repaired(const Campaign& campaign, const ChannelChoice& choice, bool quiet) {
  const auto is_named = [&choice](const ExperimentRecord& record) {
    return record.status == ExperimentStatus::ok && record.draw.kind != ExperimentKind::tuning &&
           choice.names(record);
  };
  std::int64_t named = 0;
  records_of(campaign).each([&](const ExperimentRecord& record) { named += is_named(record) ? 1 : 0; });
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  Progress progress(quiet);
  progress.begin(named);
  std::vector<Repair> repairs;
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (!is_named(record))
      return;
    progress.end_when_requested();
    try {
      const AssessedLoop loop = loop_of(campaign, record, factory);
      repairs.push_back(repaired(campaign, record, loop, *choice.of(campaign, record, loop), factory));
      progress.advance();
    } catch (const InputError& error) {  // one channel that cannot be identified does not cost the others
      progress.warn(fmt::format("experiment {}: {}", record.draw.index, error.what()));
      progress.advance(true);
    }
  });
  return repairs;
}

void repair_all(const Campaign& campaign, const ChannelChoice& choice, const RepairArguments& options) {
  const std::vector<Repair> repairs = all_repaired(campaign, choice, options.quiet);
  const std::vector<RepairFindings> findings =
      repair_findings(outcomes_of(repairs), campaign.study.aggregate.confidence);
  const std::string& method = campaign.methods[choice.method].form->method().name;
  if (!options.json) {
    print_result(fmt::format("{}: {} of {} experiments with a channel that {} names\n\n{}",
                             campaign.study.name, repairs.size(), records_of(campaign).size(), method,
                             text_of(findings)));
    return;
  }
  Json json{{"study", campaign.study.name},
            {"method", method},
            {"findings", json_of(findings)},
            {"repairs", Json::array()}};
  for (const Repair& each : repairs)
    json["repairs"].push_back(json_of(campaign.study, each));
  print_result(json_text(json));
}

ExitCode repair(const RepairArguments& options) {
  const Campaign campaign = stream_input(options.archive);
  if (!campaign.basis.sensitivity.is_known)
    throw InputError(options.archive, "a controller program that runs on the plant only (on_model is false)",
                     "one that runs on its model: a repaired model is judged by the loops that it promises");
  const ChannelChoice choice = chosen(campaign, options);
  if (options.index)
    repair_one(campaign, *options.index, choice, options.json);
  else
    repair_all(campaign, choice, options);
  return ExitCode::done;
}

}  // namespace

void add_repair(CommandSet& commands) {
  const auto options = std::make_shared<RepairArguments>();
  CLI::App& app = commands.add(
      "repair",
      "Correct the channel that a method names, predict what the repaired controller brings, and rank the "
      "channels by it",
      [options] { return repair(*options); });
  add_archive(app, options->archive);
  add_trust(app);
  app.add_option(
         "--index", options->index,
         "Show one experiment in full, with its channels ranked (default: all in which a channel is named)")
      ->check(whole_number(0, 1000000000));
  app.add_option("--method", options->method,
                 "Method that names the channel (default: the first of the archive that names mismatches, or "
                 "else channels)");
  app.add_option("--channel", options->channel, "Identify this channel instead, CV/MV; with --index");
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
