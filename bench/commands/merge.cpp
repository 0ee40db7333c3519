#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/campaign/part_merge.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/commands/failure_tally.hpp"
#include "bench/console/output.hpp"
#include "bench/console/progress.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/replaced_archive.hpp"
#include "bench/parts/loop_ranges.hpp"
#include "bench/parts/part_folder.hpp"
#include "results/archive/archive.hpp"
#include "results/document/document_text.hpp"
#include "results/summary/summary.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/number_json.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

struct MergeArguments {
  std::string output;
  std::vector<std::string> parts;  ///< empty: the parts beside the output
  std::vector<std::string> method_files;
  bool missing = false;
  bool overwrite = false;
  bool json = false;
  bool quiet = false;
};

std::string missing_text(const PartMerge& parts) {
  const LoopRanges missing = parts.missing();
  std::string text = fmt::format("{}, seed {}: {} of {} loops in {}\n", parts.study().name,
                                 parts.study().seed, parts.loops() - size_of(missing), parts.loops(),
                                 counted(static_cast<std::int64_t>(parts.part_count()), "part"));
  if (missing.empty())
    return text;
  text += fmt::format("missing: --range {}\n", to_string(missing));
  if (const std::optional<MissingPieces> pieces = parts.missing_pieces())
    text += fmt::format("missing of {} parts: --array={}\n", pieces->of, pieces->array());
  return text;
}

std::string missing_json(const PartMerge& parts) {
  const LoopRanges missing = parts.missing();
  Json ranges = Json::array();
  for (const LoopRange& range : missing)
    ranges.push_back({range.first, range.end});
  Json json{{"study", parts.study().name},        {"seed", parts.study().seed},
            {"experiments", parts.experiments()}, {"loops", parts.loops()},
            {"parts", parts.part_count()},        {"missing", size_of(missing)},
            {"missing_ranges", ranges},           {"range", to_string(missing)}};
  if (const std::optional<MissingPieces> pieces = parts.missing_pieces())
    json["pieces"] = Json{{"of", pieces->of}, {"missing", pieces->numbers}, {"array", pieces->array()}};
  return json_text(json);
}

/// Writes the archive of parts without missing loops, and prints a summary. Throws std::runtime_error if it
/// is stopped.
void write_merged(const MergeArguments& options, const PartMerge& parts, Progress& progress,
                  const std::string& command_line) {
  try {
    Campaign campaign = parts.merge(hooks_of(progress));
    note_command(campaign, command_line);
    const StudyFindings findings = findings_of(campaign);
    write_archive(options.output, campaign, findings);
    if (!options.quiet && !options.json)
      print_result(document_text(summary_document(campaign, findings, options.output)));
    FailureTally failures;
    failures.add(findings);
    failures.tell(progress);
  } catch (const Interrupted& error) {
    throw std::runtime_error(progress.explain(error));
  }
}

ExitCode merge(const MergeArguments& options, const std::string& command_line) {
  if (!options.missing) {
    require_no_input("OUTPUT", options.output, options.method_files);
    require_output_archive(options.output, "archive");
  }
  const auto methods = take_method_files(options.method_files).table;
  Progress progress(options.quiet);
  const PartMerge parts(
      options.parts.empty() ? std::vector{parts_folder_of(options.output).string()} : options.parts, methods,
      [&progress](const std::string& text) { progress.warn(text); });
  if (!options.missing && !options.overwrite)
    require_replaceable(options.output, parts.study());
  const bool complete = parts.missing().empty();
  if (complete && !options.missing)
    write_merged(options, parts, progress, command_line);
  if (options.json)
    print_result(missing_json(parts));
  else if (options.missing)
    print_result(missing_text(parts));
  else if (!complete)
    throw std::runtime_error(
        fmt::format("{}: not written, parts are missing\n{}", options.output, missing_text(parts)));
  return complete ? ExitCode::done : ExitCode::not_finished;
}

}  // namespace

void add_merge(CommandSet& commands) {
  const auto options = std::make_shared<MergeArguments>();
  CLI::App& app = commands.add("merge", "Make one archive from the parts of `run --shard` and `run --range`",
                               [options, &commands] { return merge(*options, commands.command_line()); });
  add_path(app, "OUTPUT", options->output, "Archive to write (HDF5)")->required();
  app.add_option("PARTS", options->parts, "Folders that hold parts, at any depth (default: OUTPUT.parts)");
  app.add_flag("--missing", options->missing,
               "Write nothing and list the loops that no part has: exit code 0 when none is missing, else 3");
  add_overwrite(app, options->overwrite);
  add_method_files(app, options->method_files);
  add_trust(app);
  add_json(app, options->json);
  add_quiet(app, options->quiet, "No summary");
}

}  // namespace mpm
