#include "bench/commands.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "analysis/findings/study_aggregate.hpp"
#include "bench/command_compare.hpp"
#include "bench/command_plot.hpp"
#include "bench/command_report.hpp"
#include "bench/command_reproduce.hpp"
#include "bench/command_run.hpp"
#include "bench/files.hpp"
#include "bench/record_bytes.hpp"
#include "bench/sweep_command.hpp"
#include "plants/error.hpp"
#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/gates/gate_check.hpp"
#include "results/gates/gate_file.hpp"
#include "results/gates/gate_report.hpp"
#include "results/summary/summary.hpp"
#include "results/text/experiment_text.hpp"
#include "scenarios/study_library.hpp"

namespace mpm {
namespace {

ExitCode replay(const ReplayCommand& command) {
  const Campaign campaign = read_input(command.archive);
  const ExperimentRecord& archived = experiment_of(campaign, command.index);

  // From (study, seed, index) alone: the basis case is made again too.
  const QpSolverFactory factory = qp_solver_factory(campaign.info.solver);
  const BasisCase basis = run_basis_case(campaign.study, factory);
  ExperimentRecord again = ExperimentRunner(campaign.study, basis, factory)
                               .run(command.index, archived.loop ? StorePolicy::all : StorePolicy::none);
  const bool identical = to_bytes(archived) == to_bytes(again);
  fmt::print("experiment {}: {}, {}\n", command.index, to_string(again.draw.kind), to_string(again.status));
  if (again.draw.named)
    fmt::print("{}\n", experiment_line(campaign.study, again));
  else if (again.status == ExperimentStatus::ok)
    fmt::print("located CV {} (true {}), I_MPM {:.4f}: {}\n",
               cv_name(campaign.study, again.diagnosis.predicted_cv),
               cv_name(campaign.study, again.draw.true_cv()), again.diagnosis.indicator.i_mpm,
               to_string(again.diagnosis.predicted_source));
  fmt::print("{}\n", identical ? "bit-identical to the archive" : "DIFFERS from the archive");
  return identical ? ExitCode::done : ExitCode::comparison_failed;
}

ExitCode summary(const SummaryCommand& command) {
  const Campaign campaign = read_input(command.archive);
  fmt::print("{}", command.json ? summary_json(campaign) : summary_text(campaign, command.archive));
  return ExitCode::done;
}

ExitCode check(const CheckCommand& command) {
  const Campaign campaign = read_input(command.archive);
  const GateFile gates = load_gates(command.gates, gate_names(campaign));
  std::optional<Campaign> baseline;
  if (gates.baseline)
    baseline = read_input(gates.baseline->archive.string());
  const GateCheck result = check_gates(campaign, gates, baseline ? &*baseline : nullptr);
  if (!command.junit.empty()) {
    const std::string junit = gates_junit(result, campaign, command.archive);
    write_file_atomically(command.junit, std::as_bytes(std::span(junit)));
  }
  fmt::print("{}", gates_text(result));
  return result.passed() ? ExitCode::done : ExitCode::comparison_failed;
}

ExitCode list() {
  const std::vector<StudyEntry> studies = shipped_studies();
  std::size_t width = 0;
  for (const StudyEntry& study : studies)
    width = std::max(width, study.name.size());
  for (const StudyEntry& study : studies)
    fmt::print("{:<{}}  {}\n", study.name, width, study.title);
  return ExitCode::done;
}

struct Executor {
  const std::string& command_line;

  ExitCode operator()(const RunCommand& command) const { return run(command, command_line); }
  ExitCode operator()(const ReplayCommand& command) const { return replay(command); }
  ExitCode operator()(const SummaryCommand& command) const { return summary(command); }
  ExitCode operator()(const SweepCommand& command) const {
    run_sweep(command, command_line);
    return ExitCode::done;
  }
  ExitCode operator()(const CheckCommand& command) const { return check(command); }
  ExitCode operator()(const ReportCommand& command) const { return report(command); }
  ExitCode operator()(const PlotCommand& command) const { return plot(command); }
  ExitCode operator()(const CompareCommand& command) const { return compare(command, command_line); }
  ExitCode operator()(const ReproduceCommand& command) const { return reproduce_tables(command); }
  ExitCode operator()(const ListCommand&) const { return list(); }
  ExitCode operator()(const UsageText& usage) const {
    fmt::print(usage.exit_code == 0 ? stdout : stderr, "{}", usage.text);
    return static_cast<ExitCode>(usage.exit_code);
  }
};

ExitCode complain(const char* message, ExitCode code) {
  fmt::print(stderr, "mpmbench: {}\n", message);
  return code;
}

}  // namespace

ExitCode execute(const Command& command, const std::string& command_line) {
  try {
    return std::visit(Executor{command_line}, command);
  } catch (const InputError& error) {
    return complain(error.what(), ExitCode::bad_input);
  } catch (const BadArchive& error) {
    return complain(error.what(), ExitCode::bad_input);
  } catch (const std::exception& error) {
    return complain(error.what(), ExitCode::not_finished);
  }
}

}  // namespace mpm
