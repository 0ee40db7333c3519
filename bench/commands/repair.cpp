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
#include "analysis/records/channel_information.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "results/assess/record_assessment.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/number_json.hpp"
#include "scenarios/loop/historian.hpp"

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
  const ExperimentRecord* record;
  RepairedLoop loop;
  ChannelInformation told;
};

std::string channel_name(const Study& study, const Channel& channel) {
  return fmt::format("{}/{}", study.plant.cvs[static_cast<std::size_t>(channel.cv)].name,
                     study.plant.mvs[static_cast<std::size_t>(channel.mv)].name);
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

Repair repaired(const Campaign& campaign, const ExperimentRecord& record, const Channel& channel,
                const QpSolverFactory& factory) {
  const Study& study = campaign.study;
  const Trajectory trajectory =
      record.loop ? record.loop->trajectory : simulate_experiment(study, record.draw, factory);
  const AssessedLoop loop =
      assessed_loop(study, campaign.basis.point, recorded(study, record.draw.index, trajectory));
  return {&record, repaired_loop(study, campaign.basis.point, record.draw, loop, channel, factory),
          channel_information(study, loop, channel, study.assessment.model_error)};
}

Json json_of(const FittedNumber& number) {
  return {{"value", number.value},
          {"lower", number.lower},
          {"upper", number.upper},
          {"bound", to_string(number.bound)}};
}

Json json_of(const Eigen::VectorXd& variances) {
  return std::vector<double>(variances.begin(), variances.end());
}

Json json_of(const Study& study, const Repair& repair) {
  const ChannelFit& fit = repair.loop.fit;
  return {{"index", repair.record->draw.index},
          {"kind", to_string(repair.record->draw.kind)},
          {"channel", channel_name(study, repair.loop.channel)},
          {"gain_factor", json_of(fit.gain_factor)},
          {"time_factor", json_of(fit.time_factor)},
          {"dead_time_shift", json_of(fit.dead_time_shift)},
          {"explained", fit.explained},
          {"rank", repair.told.rank},
          {"condition", std::isfinite(repair.told.condition) ? Json(repair.told.condition) : Json()},
          {"worsens", worsened_cvs(study, repair.loop.now, repair.loop.predicted)},
          {"variance",
           {{"now", json_of(repair.loop.now)},
            {"predicted", json_of(repair.loop.predicted)},
            {"repaired", json_of(repair.loop.repaired)},
            {"perfect", json_of(repair.loop.perfect)}}}};
}

std::string text_of(const FittedNumber& number) {
  return estimate_text(number.value, number.lower, number.upper, number.bound);
}

/// One repair in full.
std::string text_of(const Study& study, const Repair& repair) {
  const RepairedLoop& loop = repair.loop;
  const FittedNumber& shift = loop.fit.dead_time_shift;
  std::string text = fmt::format(
      "{}\nchannel {}, identified again: gain x {}, time constants x {}, dead time {}\n"
      "{:.0f} % of the error of its CV is explained by it\n{}\n\n",
      experiment_title(study, repair.record->draw), channel_name(study, loop.channel),
      text_of(loop.fit.gain_factor), text_of(loop.fit.time_factor),
      dead_time_text(shift.value, shift.lower, shift.upper, shift.bound, study.plant.time_unit),
      100.0 * loop.fit.explained, information_sentence(study, loop.channel, repair.told));
  Table table("", {{"variance", Table::Align::left}, {"now"}, {"predicted"}, {"repaired"}, {"perfect"}});
  const auto cell = [](const Eigen::VectorXd& variances, Eigen::Index cv) {
    return Number{variances.size() == 0 ? kNaN : variances(cv)};
  };
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
    table.row({as_label(cv_name(study, cv)), cell(loop.now, cv), cell(loop.predicted, cv),
               cell(loop.repaired, cv), cell(loop.perfect, cv)});
  const std::vector<std::string> worse = worsened_cvs(study, loop.now, loop.predicted);
  const std::string advice =
      worse.empty()
          ? ""
          : fmt::format("Do not put this channel into the controller: {} would vary more with it.\n",
                        fmt::join(worse, ", "));
  return fmt::format(
      "{}{}\n{}now: the controller as it is; predicted: what the repaired model promises, from the record "
      "alone;\n"
      "repaired: with the repaired model on the plant; perfect: with the plant itself as its model\n",
      text, table_text(table), advice);
}

/// The outcomes of all repairs that compare.
std::vector<RepairOutcome> outcomes_of(const std::vector<Repair>& repairs) {
  std::vector<RepairOutcome> outcomes;
  for (const Repair& repair : repairs)
    if (repair.loop.compares())
      outcomes.push_back({repair.record->draw.index, target_of(repair.record->draw, repair.loop.channel),
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

/// The channel of an experiment that is to be repaired: the one that the user asks for, or that the method
/// names.
struct ChannelChoice {
  std::optional<Channel> asked;
  std::size_t method = 0;  ///< place in the assessments of a record; when no channel is asked for

  std::optional<Channel> in(const ExperimentRecord& record) const {
    return asked ? asked : channel_to_repair(record.assessments[method]);
  }
};

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
  const std::optional<Channel> channel = choice.in(record);
  if (!channel)
    throw InputError("--index",
                     fmt::format("{}, in which {} names no channel", index,
                                 campaign.methods[choice.method].form->method().name),
                     "another experiment, or --channel");
  const Repair done = repaired(campaign, record, *channel, qp_solver_factory(campaign.info.solver));
  print_result(json ? json_of(campaign.study, done).dump(2) + "\n" : text_of(campaign.study, done));
}

/// The repairs of all experiments in which a channel is named; of a changed tuning the model is not to be.
std::vector<Repair> all_repaired(const Campaign& campaign, const ChannelChoice& choice, bool quiet) {
  const auto is_named = [&choice](const ExperimentRecord& record) {
    return record.status == ExperimentStatus::ok && record.draw.kind != ExperimentKind::tuning &&
           choice.in(record);
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
      repairs.push_back(repaired(campaign, record, *choice.in(record), factory));
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
  print_result(fmt::format("{}\n", json.dump(2)));
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
      "Identify the channel that a method names again, and predict what the repaired controller brings",
      [options] { return repair(*options); });
  add_archive(app, options->archive);
  add_trust(app);
  app.add_option("--index", options->index,
                 "Show one experiment in full (default: all in which a channel is named)")
      ->check(whole_number(0, 1000000000));
  app.add_option("--method", options->method,
                 "Method that names the channel (default: the first of the archive that names mismatches, or "
                 "else channels)");
  app.add_option("--channel", options->channel, "Identify this channel instead, CV/MV; with --index");
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
