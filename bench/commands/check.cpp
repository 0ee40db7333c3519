#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "results/gates/board_gates.hpp"
#include "results/gates/gate_check.hpp"
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
  std::string junit;  ///< no file when empty
};

/// The gates on these findings. The baseline must not be what is written.
GateFile gates_of(const CheckArguments& options, const std::vector<Finding>& findings) {
  GateFile gates = load_gates(options.gates, findings);
  if (gates.baseline && !options.junit.empty())
    require_no_input("--junit", options.junit, {gates.baseline->archive.string()});
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

/// The run of a suite, beside the finished board of the same loops.
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
  if (!options.junit.empty()) {
    require_no_input("--junit", options.junit, {options.archive, options.gates});
    require_output_folder(options.junit, "JUnit file");
  }
  const std::optional<fs::path> board = find_board(options.archive);
  const GateCheck result = board ? check_suite(options, *board) : check_archive(options);
  if (!options.junit.empty())
    write_text(options.junit, gates_junit(result, options.archive));
  print_result(gates_text(result));
  return result.passed() ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_check(CommandSet& commands) {
  const auto options = std::make_shared<CheckArguments>();
  CLI::App& app =
      commands.add("check", "Hold an archive or the run of a suite against the limits of a gate file",
                   [options] { return check(*options); });
  add_path(app, "ARCHIVE", options->archive, "Archive, or the folder of a suite")->required();
  add_path(app, "--gates", options->gates, "Gate file (TOML)")->required();
  add_path(app, "--suite", options->suite, "File of a suite of one's own (default: the shipped one)");
  add_path(app, "--junit", options->junit, "JUnit XML to write");
}

}  // namespace mpm
