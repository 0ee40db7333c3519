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
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/system/temporary_folder.hpp"
#include "bench/cache/cache_folder.hpp"
#include "bench/campaign/comparison_runner.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/commands/failure_tally.hpp"
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
#include "results/archive/archive.hpp"
#include "results/blind/verdict_file.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"
#include "results/plot/figure_drawing.hpp"
#include "results/report/comparison_figures.hpp"
#include "results/summary/comparison.hpp"

namespace mpm {
namespace {

struct CompareArguments {
  std::string archive;
  std::vector<std::string> methods;  ///< empty: all
  std::vector<std::string> method_files;
  std::vector<std::string> verdicts;  ///< FILE or NAME=FILE
  std::string output;                 ///< archive with the comparison; empty: none
  std::string shard;                  ///< which piece of the loops is assessed; empty: all of them
  std::optional<std::int64_t> experiments;
  int jobs = 1;
  bool discard = false;
  bool overwrite = false;
  bool dry_run = false;
  double shard_interval = RunOptions().shard_interval;
  bool fresh = false;
  bool full = false;
  bool json = false;
  bool quiet = false;
  std::string latex, figure;  ///< files of the overview, for a paper; empty: none
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
    method_table(campaign.study.assessment).known(others, "--methods");
  return named;
}

/// The methods that the user names, or every method of this program and of the archive.
std::vector<std::string> asked_methods(const Campaign& campaign, const std::vector<std::string>& named) {
  if (!named.empty() && named != std::vector<std::string>{"all"})
    return in_archive_or_known(campaign, named);
  std::vector<std::string> methods = method_table(campaign.study.assessment).names();
  for (const std::string& method : method_names(campaign))
    if (std::find(methods.begin(), methods.end(), method) == methods.end())
      methods.push_back(method);
  return methods;
}

struct NamedVerdicts {
  std::string name;
  std::filesystem::path path;
};

/// Reads FILE, whose verdicts get the name of the file, or NAME=FILE.
NamedVerdicts named_verdicts(const std::string& word) {
  const auto equals = word.find('=');
  const std::filesystem::path path = equals == std::string::npos ? word : word.substr(equals + 1);
  return {equals == std::string::npos ? path.stem().string() : word.substr(0, equals), path};
}

/// Adds the verdicts in files to those of the campaign. Returns the names of their methods.
std::vector<std::string> take_verdicts(Campaign& campaign, const std::vector<std::string>& files,
                                       const std::string& command_line) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const auto [name, path] = named_verdicts(file);
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw InputError("--verdicts", fmt::format("'{}' twice", name), "each name once");
    OutsideVerdicts verdicts = read_verdicts(path, name, campaign);
    if (!verdicts.says_which_loops)
      print_note(
          fmt::format("mpmbench: warning: {} does not say which loops it is of; they are assumed to be those "
                      "of the archive\n",
                      path.string()));
    add_verdicts(campaign, std::move(verdicts), command_line);
    names.push_back(name);
  }
  return names;
}

/// The name under which a comparison keeps shards and parts beside the output. It needs a name of its own: a
/// run of the same output keeps shards and parts as well, and its parts stay after `merge`.
std::string kept_name(const std::string& output) {
  return output + ".compared";
}

std::filesystem::path kept_shards(const std::string& output) {
  return shard_folder_of(kept_name(output));
}

std::filesystem::path kept_parts(const std::string& output) {
  return parts_folder_of(kept_name(output));
}

/// The digest of an archive. Take it before the archive is read: if somebody replaces the archive meanwhile,
/// the new one has another digest.
std::string digest_of_archive(const std::string& archive) {
  std::error_code no_status;  // the reader refuses what is no file
  return std::filesystem::is_regular_file(archive, no_status) ? digest_of_file(archive) : "";
}

/// Refuses to replace an archive that another comparison has written since this one has read it.
void require_unchanged(const CompareArguments& options, const std::string& digest) {
  std::error_code no_status;
  if (std::filesystem::equivalent(options.output, options.archive, no_status) &&
      digest_of_archive(options.archive) != digest)
    throw InputError(
        options.archive, "content that has just changed",
        "an archive that no other command writes; run the same command again to use it as it is now");
}

/// Returns the parts that others have left. If everything is to begin anew, deletes them and returns none.
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

/// The work of the command, once its archive is read.
struct ComparisonTask {
  const CompareArguments& options;
  const std::string& command_line;
  std::string digest;  ///< of the archive
  Campaign campaign;
  std::vector<std::string> asked;  ///< methods
  ComparedLoops loops;
  ComparisonOptions comparison;
};

/// Opens the comparison with the answers kept in this folder. Throws InputError if they belong to another
/// comparison.
std::unique_ptr<Comparison> open_comparison(const ComparisonTask& task, std::filesystem::path shards,
                                            Progress& progress) {
  const CompareArguments& options = task.options;
  ComparisonOptions comparison = task.comparison;
  comparison.cache = user_cache();
  comparison.fresh = options.fresh;
  comparison.threshold_options = threshold_options(options.method_files);
  comparison.archive = task.digest;
  comparison.shards = std::move(shards);
  comparison.kept = {.leftovers = options.discard ? Leftovers::discard : Leftovers::resume,
                     .interval = options.shard_interval,
                     .warn = [&progress](const std::string& text) { progress.warn(text); }};
  if (!comparison.part && !options.output.empty())
    comparison.parts = parts_to_take(options.output, options.discard);
  try {
    return std::make_unique<Comparison>(task.campaign, task.loops, comparison);
  } catch (const OtherRun& error) {
    throw error.with_advice();
  }
}

/// Returns what `work` returns. If the work is stopped, the error says how to resume it.
template <class Work>
auto advised(const ComparisonTask& task, const Progress& progress, const Work& work) {
  try {
    return work();
  } catch (const Interrupted& error) {
    throw std::runtime_error(
        progress.explain(error) +
        (task.options.output.empty()
             ? ""
             : how_to_go_on("beside " + task.options.output, without_discard(task.command_line))));
  }
}

/// Assesses a part of the loops. Their answers wait for the comparison of all loops.
std::string compare_part(const ComparisonTask& task, Progress& progress) {
  if (task.comparison.methods.empty())
    return "every loop has been assessed already\n";
  const PartNumber& part = *task.comparison.part;
  const std::filesystem::path folder = kept_parts(task.options.output) / part_name("", part);
  make_output_folder(folder.parent_path(), "parts");
  const std::unique_ptr<Comparison> comparison = open_comparison(task, folder, progress);
  advised(task, progress, [&] { comparison->run(hooks_of(progress)); });
  comparison->compact();
  return fmt::format("{}: {} loops assessed, part {} of {}\n", folder.string(), comparison->count(),
                     part.number, part.of);
}

/// Writes the overview as files, for a paper.
void write_overview(const CompareArguments& options, const Campaign& shown, const StudyFindings& findings) {
  if (!options.latex.empty())
    write_text(options.latex, comparison_latex(shown, findings));
  if (!options.figure.empty())
    write_text(options.figure, draw_figure(comparison_rates_figure(shown.study, findings.methods),
                                           figure_format_of(options.figure)));
}

/// Says how often each method that was asked for is right. Writes the archive with all methods if an output
/// is asked for.
std::string found_text(const ComparisonTask& task, FailureTally& failures) {
  const CompareArguments& options = task.options;
  const auto text = [&](const Campaign& shown, const StudyFindings& findings) {
    write_overview(options, shown, findings);
    const Document document = comparison_document(shown, findings);
    return options.json ? document_json(document) : document_text(document, kTerminalWidth, options.full);
  };
  const bool shows_all = task.asked == method_names(task.campaign) && !options.experiments;
  std::string found;
  if (!shows_all) {
    const Campaign shown = with_methods(task.campaign, task.asked, options.experiments);
    const StudyFindings findings = findings_of(shown);
    failures.add(findings);
    found = text(shown, findings);
  }
  if (!shows_all && options.output.empty())
    return found;
  const StudyFindings findings = findings_of(task.campaign);
  if (!options.output.empty())
    write_archive(options.output, task.campaign, findings);
  if (!shows_all)
    return found;
  failures.add(findings);
  return text(task.campaign, findings);
}

/// Adds the missing answers to the campaign, and shows and writes what was found. No other comparison can
/// write the output meanwhile. Without an output the answers wait among the temporary files.
std::string compare_all(ComparisonTask& task, Progress& progress) {
  const std::string& output = task.options.output;
  std::optional<TemporaryFolder> temporary;
  std::unique_ptr<Comparison> comparison;  // its shards are locked until the archive is written
  std::optional<ShardFolder> alone;        // the lock if there is nothing to assess
  if (output.empty())
    temporary.emplace();
  if (!task.comparison.methods.empty())
    comparison =
        open_comparison(task, temporary ? temporary->path() / "compared" : kept_shards(output), progress);
  else if (!output.empty())
    alone.emplace(kept_shards(output));
  require_unchanged(task.options, task.digest);
  FailureTally failures;
  std::string found = advised(task, progress, [&] {
    if (comparison) {
      const CampaignHooks hooks = hooks_of(progress);
      comparison->run(hooks);
      comparison->add_to(task.campaign, task.command_line, hooks.stop);
    }
    return found_text(task, failures);
  });
  if (comparison && !output.empty()) {
    comparison.reset();
    remove_shard_folder(kept_shards(output));
  }
  failures.tell(progress);
  return found;
}

/// What the comparison would do.
std::string intended_text(const ComparisonTask& task) {
  const CompareArguments& options = task.options;
  const std::vector<std::string>& methods = task.comparison.methods;
  const std::int64_t experiments = std::ssize(task.loops.experiments),
                     calibration = std::ssize(task.campaign.calibration.loops);
  return fmt::format(
      "methods: {}\nloops: {} of {} ({} experiments, {} calibration loops) to be assessed, {} at "
      "once\nfiles: {}\nnothing was assessed, nothing was written\n",
      methods.empty() ? "none: the archive has them all" : fmt::to_string(fmt::join(methods, ", ")),
      methods.empty() ? 0 : Comparison(task.campaign, task.loops, task.comparison).count(),
      experiments + calibration, experiments, calibration, options.jobs,
      options.output.empty() ? "none"
      : task.comparison.part ? fmt::format("shards in {}, for the same command without --shard",
                                           kept_parts(options.output).string())
                             : output_text(options.output, kept_shards(options.output)));
}

/// Refuses an output that is an input or cannot be written, and a part without an output beside which it is
/// kept.
void require_output(const CompareArguments& options) {
  for (const std::string& file : {options.latex, options.figure})
    if (!file.empty())
      require_output_folder(file, "overview");
  if (!options.figure.empty())
    figure_format_of(options.figure);
  if (options.output.empty()) {
    if (!options.shard.empty())
      throw InputError("--shard", "no --output", "an --output, beside which the parts are kept");
    return;
  }
  std::vector<std::string> inputs = options.method_files;
  for (const std::string& file : options.verdicts)
    inputs.push_back(named_verdicts(file).path.string());
  require_no_input("--output", options.output, inputs);
  require_output_archive(options.output, "archive");
}

/// Returns the methods that are asked for: those named and those of files, or all methods if there are
/// neither. Adds the verdicts in files to those of the campaign.
std::vector<std::string> take_asked(Campaign& campaign, const CompareArguments& options,
                                    const std::string& command_line) {
  auto [given, table] = take_method_files(options.method_files);
  campaign.study.assessment.table = std::move(table);
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

/// Assesses the loops of an archive by the methods that it does not have yet, and prints how often each
/// method that was asked for is right. Writes the archive with the new answers if an output is asked for.
/// Loops that the archive has not kept are run again from (study, seed, index).
ExitCode compare(const CompareArguments& options, const std::string& command_line) {
  ComparisonTask task{
      options, command_line, digest_of_archive(options.archive), stream_input(options.archive), {}, {}, {}};
  require_output(options);
  if (!options.output.empty() && options.shard.empty() && !options.overwrite)
    require_replaceable(options.output, task.campaign.study);
  task.asked = take_asked(task.campaign, options, command_line);
  task.loops = compared_loops(task.campaign, task.asked, options.experiments);
  if (task.loops.experiments.empty())
    throw InputError(options.archive, "no loop that ran to its end", "one or more to compare methods on");
  task.comparison = {
      .methods = task.loops.missing, .jobs = options.jobs, .part = part_of_option(options.shard)};
  Progress progress(options.quiet);
  print_result(options.dry_run        ? intended_text(task)
               : task.comparison.part ? compare_part(task, progress)
                                      : compare_all(task, progress));
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
                 "method (repeatable)");
  add_path(app, "-o,--output", options->output,
           "Archive to write, with the comparison in it (HDF5); may be ARCHIVE itself. Finished work is kept "
           "beside it until then, and the same command resumes it");
  add_experiments(app, options->experiments, "Compare only the first N experiments");
  add_path(app, "--latex", options->latex, "Table of the overview to write, for a paper: NAME.tex");
  add_path(app, "--figure", options->figure,
           "Figure of all rates with their intervals to write: NAME.svg, NAME.pdf or NAME.png");
  add_part_of(app, options->shard, "loops");
  app.add_flag("--discard", options->discard,
               "Delete what an interrupted comparison of this output has finished, and start again");
  add_overwrite(app, options->overwrite);
  add_shard_interval(app, options->shard_interval);
  add_jobs(app, options->jobs, "How many loops are assessed at once");
  add_untimed_dry_run(app, options->dry_run);
  add_fresh(app, options->fresh);
  add_full(app, options->full);
  add_json(app, options->json);
  add_quiet(app, options->quiet);
}

}  // namespace mpm
