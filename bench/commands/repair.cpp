#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "results/assess/experiment_repair.hpp"
#include "results/assess/repair_form.hpp"
#include "results/document/document_text.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/number_json.hpp"
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

ChannelChoice chosen(const Campaign& campaign, const RepairArguments& options) {
  if (options.channel.empty())
    return choice_of_method(campaign, options.method);
  if (!options.index)
    throw InputError("--channel", "no --index", "one channel of one experiment");
  return choice_of_channel(campaign.study, options.channel);
}

const std::string& name_of_method(const Campaign& campaign, const ChannelChoice& choice) {
  return campaign.methods[choice.method].form->method().name;
}

void repair_one(const Campaign& campaign, std::int64_t index, const ChannelChoice& choice, bool json) {
  const ExperimentRecord record = experiment_of(campaign, index);
  if (record.status != ExperimentStatus::ok)
    throw InputError("--index", fmt::format("{}, which did not run to its end", index),
                     "an experiment that did");
  const Study& study = campaign.study;
  const auto [repair, prospects] =
      repairs_of_experiment(campaign, record, choice, qp_solver_factory(campaign.info.solver));
  if (json) {
    Json all = repair ? repair_json(study, *repair) : repair_heading_json(record.draw);
    all["candidates"] = prospects_json(study, prospects);
    print_result(json_text(all));
    return;
  }
  print_result(fmt::format("{}\n{}{}", experiment_title(study, record.draw),
                           repair ? repair_text(study, *repair)
                                  : fmt::format("{} names no channel\n\n", name_of_method(campaign, choice)),
                           prospects.empty() ? "No channel has an error that shows in the record.\n"
                                             : table_text(prospects_table(study, prospects))));
}

/// The repairs of all experiments in which a channel is named.
std::vector<ExperimentRepair> all_repaired(const Campaign& campaign, const ChannelChoice& choice,
                                           bool quiet) {
  std::int64_t named = 0;
  records_of(campaign).each([&](const ExperimentRecord& record) { named += choice.names(record) ? 1 : 0; });
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  Progress progress(quiet);
  progress.begin(named);
  std::vector<ExperimentRepair> repairs;
  records_of(campaign).each([&](const ExperimentRecord& record) {
    if (!choice.names(record))
      return;
    progress.end_when_requested();
    try {
      repairs.push_back(*experiment_repair(campaign, record, choice, factory));
      progress.advance();
    } catch (const InputError& error) {  // a channel that cannot be identified does not stop the others
      progress.warn(fmt::format("experiment {}: {}", record.draw.index, error.what()));
      progress.advance(true);
    }
  });
  return repairs;
}

void repair_all(const Campaign& campaign, const ChannelChoice& choice, const RepairArguments& options) {
  const std::vector<ExperimentRepair> repairs = all_repaired(campaign, choice, options.quiet);
  const std::vector<RepairFindings> findings = repair_findings(repairs, campaign.study.aggregate.confidence);
  if (!options.json) {
    print_result(fmt::format("{}: {} of {} experiments with a channel that {} names\n\n{}",
                             campaign.study.name, repairs.size(), records_of(campaign).size(),
                             name_of_method(campaign, choice), repair_findings_text(findings)));
    return;
  }
  Json json{{"study", campaign.study.name},
            {"method", name_of_method(campaign, choice)},
            {"findings", repair_findings_json(findings)},
            {"repairs", Json::array()}};
  for (const ExperimentRepair& each : repairs)
    json["repairs"].push_back(repair_json(campaign.study, each));
  print_result(json_text(json));
}

ExitCode repair(const RepairArguments& options) {
  const Campaign campaign = stream_input(options.archive);
  require_repairable(campaign, options.archive);
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
