#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_file.hpp"
#include "results/gates/gate_report.hpp"

namespace mpm {
namespace {

struct CheckArguments {
  std::string archive;
  std::string gates;
  std::string junit;  ///< no file when empty
};

ExitCode check(const CheckArguments& options) {
  if (!options.junit.empty()) {
    require_no_input("--junit", options.junit, {options.archive, options.gates});
    require_output_folder(options.junit, "JUnit file");
  }
  const Campaign campaign = stream_input(options.archive);
  const GateFile gates = load_gates(options.gates, gate_findings(campaign));
  std::optional<Campaign> baseline;
  if (gates.baseline) {
    if (!options.junit.empty())
      require_no_input("--junit", options.junit, {gates.baseline->archive.string()});
    baseline = stream_input(gates.baseline->archive.string());
  }
  const GateCheck result = check_gates(campaign, gates, baseline ? &*baseline : nullptr);
  if (!options.junit.empty())
    write_text(options.junit, gates_junit(result, campaign, options.archive));
  print_result(gates_text(result));
  return result.passed() ? ExitCode::done : ExitCode::comparison_failed;
}

}  // namespace

void add_check(CommandSet& commands) {
  const auto options = std::make_shared<CheckArguments>();
  CLI::App& app = commands.add("check", "Hold an archive against the limits of a gate file",
                               [options] { return check(*options); });
  add_archive(app, options->archive);
  add_path(app, "--gates", options->gates, "Gate file (TOML)")->required();
  add_path(app, "--junit", options->junit, "JUnit XML to write");
}

}  // namespace mpm
