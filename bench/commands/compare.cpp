#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/method_table.hpp"
#include "bench/campaign/calibration_runs.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/outside_files.hpp"
#include "bench/files/replaced_archive.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/parts/part_folder.hpp"
#include "bench/shards/shard_folder.hpp"
#include "bench/shards/shard_identity.hpp"
#include "bench/version.hpp"
#include "plants/error.hpp"
#include "plants/system/temporary_folder.hpp"
#include "results/archive/archive.hpp"
#include "results/blind/verdict_file.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

struct CompareArguments {
  std::string archive;
  std::vector<std::string> methods;  ///< empty: all
  std::vector<std::string> method_files;
  std::vector<std::string> verdicts;  ///< FILE or NAME=FILE
  std::string output;                 ///< archive with the comparison; none when empty
  std::string shard;                  ///< which piece of the loops is assessed; empty: all of them
  std::optional<std::int64_t> experiments;
  int jobs = 1;
  bool discard = false;
  bool overwrite = false;
  bool dry_run = false;
  double shard_interval = RunOptions().shard_interval;
  bool json = false;
  bool quiet = false;
};

/// Throws InputError for a method that neither this program nor the archive has, or one that is named twice.
std::vector<std::string> in_archive_or_known(const Campaign& campaign,
                                             const std::vector<std::string>& named) {
  const std::vector<std::string> archived = method_names(campaign);
  std::vector<std::string> others;
  for (auto method = named.begin(); method != named.end(); ++method) {
    if (std::find(named.begin(), method, *method) != method)
      throw InputError("--methods", fmt::format("'{}' twice", *method), "each method once");
    if (std::find(archived.begin(), archived.end(), *method) == archived.end())
      others.push_back(*method);
  }
  if (!others.empty())
    known_methods(others, "--methods");
  return named;
}

/// Those that the user names, or every method of this program and of the archive.
std::vector<std::string> asked_methods(const Campaign& campaign, const std::vector<std::string>& named) {
  if (!named.empty() && named != std::vector<std::string>{"all"})
    return in_archive_or_known(campaign, named);
  std::vector<std::string> methods = assessment_method_names();
  for (const std::string& method : method_names(campaign))
    if (std::find(methods.begin(), methods.end(), method) == methods.end())
      methods.push_back(method);
  return methods;
}

struct NamedVerdicts {
  std::string name;
  std::filesystem::path path;
};

/// FILE, which has the name of the file, or NAME=FILE.
NamedVerdicts named_verdicts(const std::string& word) {
  const auto equals = word.find('=');
  const std::filesystem::path path = equals == std::string::npos ? word : word.substr(equals + 1);
  return {equals == std::string::npos ? path.stem().string() : word.substr(0, equals), path};
}

/// Puts the verdicts of files beside those of the campaign. Returns the names of their methods.
std::vector<std::string> take_verdicts(Campaign& campaign, const std::vector<std::string>& files,
                                       const std::string& command_line) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const auto [name, path] = named_verdicts(file);
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw InputError("--verdicts", fmt::format("'{}' twice", name), "each name once");
    OutsideVerdicts verdicts = read_verdicts(path, name, campaign);
    if (!verdicts.says_which_loops)
      print_note(fmt::format(
          "mpmbench: {} does not say which loops it is of; that they are those of the archive is taken on "
          "trust\n",
          path.string()));
    add_verdicts(campaign, std::move(verdicts), command_line);
    names.push_back(name);
  }
  return names;
}

/// What a comparison keeps has a name of its own beside the output: a run of the same output keeps shards and
/// parts as well, and parts stay after `merge`.
std::string kept_name(const std::string& output) {
  return output + ".compared";
}

std::filesystem::path kept_shards(const std::string& output) {
  return shard_folder_of(kept_name(output));
}

std::filesystem::path kept_parts(const std::string& output) {
  return parts_folder_of(kept_name(output));
}

/// Before the archive is read: what somebody writes into its place meanwhile has another.
std::string digest_of_archive(const std::string& archive) {
  std::error_code no_status;  // what is no file is refused by its reader
  return std::filesystem::is_regular_file(archive, no_status) ? digest_of_file(archive) : "";
}

/// Refuses to replace an archive that another comparison has written since this one has read it.
void require_unchanged(const CompareArguments& options, const std::string& digest) {
  std::error_code no_status;
  if (std::filesystem::equivalent(options.output, options.archive, no_status) &&
      digest_of_archive(options.archive) != digest)
    throw InputError(options.archive, "another content than a moment ago",
                     "an archive that no other command writes; the same command again takes it as it is now");
}

/// The parts that others have left, or none when all is to begin anew: they are deleted then.
std::vector<std::filesystem::path> parts_to_take(const std::string& output, bool discard) {
  std::vector<std::filesystem::path> parts;
  std::error_code no_folder;
  for (const auto& part : std::filesystem::directory_iterator(kept_parts(output), no_folder))
    parts.push_back(part.path());
  std::sort(parts.begin(), parts.end());
  if (!discard)
    return parts;
  for (const std::filesystem::path& part : parts)
    remove_shard_folder(part);
  std::filesystem::remove(kept_parts(output), no_folder);
  return {};
}

/// Where the answers of a comparison wait.
KeptAssessments kept_assessments(const CompareArguments& options, std::filesystem::path shards,
                                 std::string archive, Progress& progress) {
  KeptAssessments kept{.shards = std::move(shards),
                       .parts = {},
                       .archive = std::move(archive),
                       .leftovers = options.discard ? Leftovers::discard : Leftovers::resume,
                       .interval = options.shard_interval,
                       .warn = [&progress](const std::string& text) { progress.warn(text); }};
  if (options.shard.empty() && !options.output.empty())
    kept.parts = parts_to_take(options.output, options.discard);
  return kept;
}

/// Throws InputError where what is kept belongs to another comparison.
void open(std::optional<Comparison>& comparison, const Campaign& campaign, const ComparisonOptions& options) {
  try {
    comparison.emplace(campaign, options);
  } catch (const OtherRun& error) {
    throw error.with_advice();
  }
}

/// What `work` returns; stopped, it says how to go on.
template <class Work>
auto advised(const CompareArguments& options, const Progress& progress, const std::string& command_line,
             const Work& work) {
  try {
    return work();
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error) +
                             (options.output.empty()
                                  ? ""
                                  : how_to_go_on("beside " + options.output, without_discard(command_line))));
  }
}

/// A piece of the loops, whose answers wait for the comparison of all of them.
ExitCode compare_part(const Campaign& campaign, ComparisonOptions comparison_options,
                      const CompareArguments& options, const std::string& archive, Progress& progress,
                      const std::string& command_line) {
  if (comparison_options.methods.empty()) {
    print_result("every loop is assessed already\n");
    return ExitCode::done;
  }
  const ShardNumber& shard = *comparison_options.shard;
  const std::filesystem::path folder = kept_parts(options.output) / part_name("", shard);
  make_output_folder(folder.parent_path(), "parts");
  comparison_options.kept = kept_assessments(options, folder, archive, progress);
  std::optional<Comparison> comparison;
  open(comparison, campaign, comparison_options);
  const std::int64_t count = comparison->tally().count;
  advised(options, progress, command_line, [&] { comparison->run(hooks_of(progress)); });
  comparison->compact();
  print_result(
      fmt::format("{}: {} loops assessed, part {} of {}\n", folder.string(), count, shard.number, shard.of));
  return ExitCode::done;
}

/// How often each of the methods that are asked for is right.
std::string findings_text(const CompareArguments& options, const Campaign& campaign,
                          const std::vector<std::string>& asked) {
  const Campaign shown = with_methods(campaign, asked, options.experiments);
  const StudyFindings findings = findings_of(shown);
  return options.json ? comparison_json(shown, findings) : comparison_text(shown, findings);
}

/// Adds the answers that are missing to the campaign, and writes the archive with them when an output is
/// asked for; no other comparison writes it meanwhile. Returns what was found. Without an output the answers
/// wait among the temporary files.
std::string complete(Campaign campaign, ComparisonOptions comparison_options, const CompareArguments& options,
                     const std::vector<std::string>& asked, const std::string& archive, Progress& progress,
                     const std::string& command_line) {
  std::optional<TemporaryFolder> temporary;
  std::optional<Comparison> comparison;  // its shards are locked until the archive is written
  std::optional<ShardFolder> alone;      // where there is nothing to assess
  if (!comparison_options.methods.empty()) {
    if (options.output.empty())
      temporary.emplace();
    comparison_options.kept = kept_assessments(
        options, temporary ? temporary->path() / "compared" : kept_shards(options.output), archive, progress);
    open(comparison, campaign, comparison_options);
  } else if (!options.output.empty()) {
    alone.emplace(kept_shards(options.output));
  }
  require_unchanged(options, archive);
  std::string found = advised(options, progress, command_line, [&] {
    if (comparison) {
      const CampaignHooks hooks = hooks_of(progress);
      comparison->run(hooks);
      comparison->add_to(campaign, command_line, hooks.stop);
    }
    std::string text = findings_text(options, campaign, asked);
    if (!options.output.empty())
      write_archive(options.output, campaign, findings_of(campaign));
    return text;
  });
  if (comparison && !options.output.empty()) {
    comparison.reset();
    remove_shard_folder(kept_shards(options.output));
  }
  return found;
}

/// What the comparison would do.
std::string intended_text(const Campaign& campaign, const ComparisonOptions& comparison,
                          const CompareArguments& options) {
  ComparisonOptions in_memory = comparison;
  in_memory.kept.reset();
  return fmt::format(
      "methods: {}\nloops: {} of {} ({} experiments, {} calibration loops) to be assessed, {} at "
      "once\nfiles: "
      "{}\nnothing was assessed, nothing was written\n",
      comparison.methods.empty() ? "none that the archive lacks"
                                 : fmt::to_string(fmt::join(comparison.methods, ", ")),
      comparison.methods.empty() ? 0 : Comparison(campaign, in_memory).tally().count,
      compared_loops(campaign, options.experiments) + std::ssize(campaign.calibration.loops),
      compared_loops(campaign, options.experiments), campaign.calibration.loops.size(), options.jobs,
      options.output.empty() ? "none"
      : comparison.shard     ? fmt::format("shards in {}, for the same command without --shard",
                                           kept_parts(options.output).string())
                             : output_text(options.output, kept_shards(options.output)));
}

/// Refuses an output that is an input or cannot be written, and parts that would have no place.
void require_output(const CompareArguments& options) {
  if (options.output.empty()) {
    if (!options.shard.empty())
      throw InputError("--shard", "no --output", "with --output, beside which the parts wait");
    return;
  }
  std::vector<std::string> inputs = options.method_files;
  for (const std::string& file : options.verdicts)
    inputs.push_back(named_verdicts(file).path.string());
  require_no_input("--output", options.output, inputs);
  require_output_archive(options.output, "archive");
}

/// The methods that are asked for: those named, those of files, and with neither all. Puts the verdicts of
/// files beside those of the campaign.
std::vector<std::string> take_asked(Campaign& campaign, const CompareArguments& options,
                                    const std::string& command_line) {
  std::vector<std::string> given = take_method_files(options.method_files);
  for (std::string& name : take_verdicts(campaign, options.verdicts, command_line))
    given.push_back(std::move(name));
  std::vector<std::string> asked = given.empty() || !options.methods.empty()
                                       ? asked_methods(campaign, options.methods)
                                       : method_names(campaign);
  for (const std::string& name : given)
    if (std::find(asked.begin(), asked.end(), name) == asked.end())
      asked.push_back(name);
  return asked;
}

/// Assesses the loops of an archive by the methods that it does not have yet, prints how often each of those
/// that are asked for is right, and writes the archive with them when an output is asked for. Loops that the
/// archive has not kept are run again from (study, seed, index).
ExitCode compare(const CompareArguments& options, const std::string& command_line) {
  const std::string archive = digest_of_archive(options.archive);
  Campaign campaign = stream_input(options.archive);
  require_output(options);
  if (!options.output.empty() && options.shard.empty() && !options.overwrite)
    require_replaceable(options.output, campaign.study);
  if (compared_loops(campaign, options.experiments) == 0)
    throw InputError(options.archive, "no loop that ran to its end", "one or more to compare methods on");
  const std::vector<std::string> asked = take_asked(campaign, options, command_line);
  const std::vector<std::string> missing = missing_methods(campaign, asked, options.experiments);
  Progress progress(options.quiet);
  const ComparisonOptions comparison{missing, options.experiments, options.jobs, {}, shard_of(options.shard)};
  if (options.dry_run) {
    print_result(intended_text(campaign, comparison, options));
    return ExitCode::done;
  }
  if (comparison.shard)
    return compare_part(campaign, comparison, options, archive, progress, command_line);
  print_result(complete(std::move(campaign), comparison, options, asked, archive, progress, command_line));
  return ExitCode::done;
}

}  // namespace

void add_compare(CommandSet& commands) {
  const auto options = std::make_shared<CompareArguments>();
  CLI::App& app = commands.add(
      "compare", "Assess the loops of an archive by several methods, and compare how often each is right",
      [options, &commands] { return compare(*options, commands.command_line()); });
  add_archive(app, options->archive);
  add_trust(app);
  add_methods_option(app, options->methods, "Methods, separated by commas, or all");
  add_method_files(app, options->method_files);
  app.add_option("--verdicts", options->verdicts,
                 "CSV file of verdicts on the loops of `export --blind`, FILE or NAME=FILE; compared like a "
                 "method. May be given several times");
  add_path(app, "-o,--output", options->output,
           "Archive to write, with the comparison in it (HDF5); may be ARCHIVE itself. Until then finished "
           "work waits beside it, and the same command resumes it");
  add_experiments(app, options->experiments, "Compare only the first N experiments");
  add_shard_of(app, options->shard, "loops");
  app.add_flag("--discard", options->discard,
               "Delete what an interrupted comparison of this output has finished, and start again");
  add_overwrite(app, options->overwrite);
  add_shard_interval(app, options->shard_interval);
  add_jobs(app, options->jobs, "How many loops are assessed at once");
  add_untimed_dry_run(app, options->dry_run);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
