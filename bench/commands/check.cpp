#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_markdown.hpp"
#include "results/gates/board_gates.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_document.hpp"
#include "results/gates/gate_file.hpp"
#include "results/gates/gate_report.hpp"
#include "results/suite/board_file.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

struct CheckArguments {
  std::string archive;
  std::string gates;
  std::string suite;
  std::string junit;  ///< files to write; empty: none
  std::string markdown;
  std::string badge;
  bool json = false;
  bool quiet = false;
};

/// A file that a check writes.
struct CheckOutput {
  const char* option;
  const std::string& path;
  const char* what;
};

/// The outputs that the user asks for.
std::vector<CheckOutput> outputs_of(const CheckArguments& options) {
  std::vector<CheckOutput> outputs;
  for (const CheckOutput& output : {CheckOutput{"--junit", options.junit, "JUnit file"},
                                    CheckOutput{"--markdown", options.markdown, "Markdown file"},
                                    CheckOutput{"--badge", options.badge, "badge"}})
    if (!output.path.empty())
      outputs.push_back(output);
  return outputs;
}

/// Refuses outputs that would replace an input or each other.
void require_outputs(const CheckArguments& options) {
  std::vector<fs::path> taken;
  for (const CheckOutput& output : outputs_of(options)) {
    require_no_input(output.option, output.path, {options.archive, options.gates});
    require_output_folder(output.path, output.what);
    std::error_code error;  // a device or a pipe takes several outputs
    const fs::path path = fs::weakly_canonical(output.path, error);
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
      continue;
    if (std::find(taken.begin(), taken.end(), path) != taken.end())
      throw InputError(output.option, fmt::format("{}, which another option writes", output.path),
                       "a file for each of --junit, --markdown and --badge");
    taken.push_back(path);
  }
}

/// The gates on these findings. Refuses an output that would replace the baseline.
GateFile gates_of(const CheckArguments& options, const std::vector<Finding>& findings) {
  GateFile gates = load_gates(options.gates, findings);
  if (gates.baseline)
    for (const CheckOutput& output : outputs_of(options))
      require_no_input(output.option, output.path, {gates.baseline->archive.string()});
  return gates;
}

GateCheck check_archive(const CheckArguments& options) {
  const Campaign campaign = stream_input(options.archive);
  const GateFile gates = gates_of(options, gate_findings(campaign));
  std::optional<Campaign> baseline;
  if (gates.baseline)
    baseline = stream_input(gates.baseline->archive.string());
  return check_gates(campaign, gates, baseline ? &*baseline : nullptr);
}

/// Checks the run of a suite, beside the finished board if that has the same loops.
GateCheck check_suite(const CheckArguments& options, const fs::path& board) {
  const BoardHeading heading = board_heading(board);
  const std::string& file = options.suite.empty() ? heading.suite : options.suite;
  Suite suite = find_suite(file);
  const fs::path finished = finished_board_path(suite);
  std::error_code no_status;
  const bool same_loops = heading.seed == suite.seed;
  if (!same_loops)
    suite = find_suite(file, {.seed = heading.seed});
  BoardRun run{std::move(suite), {}, {}};
  run.board = read_board(board, run.suite);
  if (same_loops && fs::is_regular_file(finished, no_status))
    run.finished = read_board(finished, run.suite);
  const GateFile gates = gates_of(options, gate_findings(run));
  std::optional<FinishedBoard> baseline;
  if (gates.baseline) {
    const fs::path& path = gates.baseline->archive;
    const std::optional<fs::path> found = find_board(path);
    if (!found)
      throw InputError(fmt::format("baseline {}", path.string()), "no board of a suite",
                       "the folder of an earlier run of the suite, or its SUITE.board.json");
    baseline = read_board(*found, run.suite);
  }
  return check_gates(run, gates, baseline ? &*baseline : nullptr);
}

ExitCode check(const CheckArguments& options) {
  require_outputs(options);
  const std::optional<fs::path> board = find_board(options.archive);
  const GateCheck result = board ? check_suite(options, *board) : check_archive(options);
  const Document document = gates_document(result, options.archive);
  if (!options.junit.empty())
    write_text(options.junit, gates_junit(result, options.archive));
  if (!options.markdown.empty())
    write_text(options.markdown, document_markdown(document));
  if (!options.badge.empty())
    write_text(options.badge, gates_badge(result));
  if (options.json)
    print_result(document_json(document));
  else
    print_result(options.quiet ? stopped_text(result) : gates_text(result));
  return result.passed() ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_check(CommandSet& commands) {
  const auto options = std::make_shared<CheckArguments>();
  CLI::App& app =
      commands.add("check", "Compare an archive or the run of a suite with the limits of a gate file",
                   [options] { return check(*options); });
  add_path(app, "ARCHIVE", options->archive, "Archive, or the folder of a suite")->required();
  add_path(app, "--gates", options->gates, "Gate file (TOML)")->required();
  add_path(app, "--suite", options->suite, "File of your own suite (default: the shipped one)");
  add_path(app, "--junit", options->junit, "JUnit XML to write");
  add_path(app, "--markdown", options->markdown, "Summary to write, in Markdown");
  add_path(app, "--badge", options->badge, "Badge to write, the JSON of an endpoint of shields.io");
  add_quiet(app, options->quiet, "Print only why the check fails");
  add_json(app, options->json);
}

}  // namespace mpm
