#include "bench/commands/common_options.hpp"

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>

#include "analysis/methods/composite_method.hpp"
#include "analysis/methods/method_file.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/outside_program.hpp"
#include "base/system/program_trust.hpp"
#include "bench/commands/option_checks.hpp"
#include "bench/files/outside_files.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

constexpr std::uint64_t kMostExperiments = 1'000'000'000;  // the limit of the indices of experiments

/// Accepts any word that is not empty.
CLI::Validator word_that_is(const std::string& allowed) {
  return {[allowed](const std::string& word) {
            return word.empty() ? "found nothing; allowed: " + allowed : std::string();
          },
          ""};
}

}  // namespace

CLI::Option* add_path(CLI::App& app, const std::string& name, std::string& path,
                      const std::string& description) {
  return app.add_option(name, path, description)->check(word_that_is("a path"));
}

void add_part_option(CLI::App& app, const std::string& name, std::string& part, const std::string& allowed,
                     const std::string& description) {
  app.add_option(name, part, description)->check(word_that_is(allowed));
}

void add_seed(CLI::App& app, std::optional<std::uint64_t>& seed, const std::string& description,
              std::uint64_t largest) {
  app.add_option("--seed", seed, description)->check(whole_number(0, largest));
}

void add_changes(CLI::App& app, std::vector<std::string>& changes, const std::string& description) {
  app.add_option("--set", changes, description)->allow_extra_args(false);
}

void add_archive(CLI::App& app, std::string& archive) {
  add_path(app, "ARCHIVE", archive, "Archive")->required();
}

void add_trust(CLI::App& app) {
  app.add_flag_callback(
      "--trust-programs", [] { trust_every_program(); },
      "Run the programs and load the FMU named by the study of an archive or part");
}

void add_index(CLI::App& app, std::int64_t& index) {
  app.add_option("INDEX", index, "Index of the experiment")
      ->required()
      ->check(whole_number(0, kMostExperiments));
}

void add_experiments(CLI::App& app, std::optional<std::int64_t>& experiments,
                     const std::string& description) {
  app.add_option("--experiments", experiments, description)->check(whole_number(1, kMostExperiments));
}

namespace {

/// Cores that this process may use: launchers and batch systems leave it some of the machine.
int usable_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  return ::sched_getaffinity(0, sizeof cores, &cores) == 0
             ? CPU_COUNT(&cores)
             : static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace

void add_jobs(CLI::App& app, int& jobs, const std::string& description) {
  jobs = std::max(1, usable_cores());
  app.add_option("--jobs", jobs, description)->check(whole_number(1, 1024))->capture_default_str();
}

void add_solver(CLI::App& app, std::string& solver) {
  app.add_option("--solver", solver, "QP solver")->check(one_of(qp_solver_names()))->capture_default_str();
}

void add_methods_option(CLI::App& app, std::vector<std::string>& methods, const std::string& description) {
  app.add_option("--methods", methods,
                 fmt::format("{}. Available: {}", description, fmt::join(shipped_methods().names(), ", ")))
      ->delimiter(',');
}

void add_method_files(CLI::App& app, std::vector<std::string>& files) {
  app.add_option(
      "--method-file", files,
      "File of methods: programs, [method.NAME] command = [...], or two as one, detector = ..., namer = ...; "
      "may be given several times");
}

namespace {

AssessmentMethodInfo method_of_program(const MethodProgram& program) {
  trust_program(program.command);
  AssessmentMethodInfo method = program_method(program);
  method.given_options = program.options;
  method.fingerprint = fmt::format("{}, options {}", command_identity(program.command), program.options);
  return method;
}

AssessmentMethodInfo method_of_composite(const MethodProgram& composite, const MethodTable& table) {
  const AssessmentMethodInfo &detector = table.method(composite.detector),
                             &namer = table.method(composite.namer);
  AssessmentMethodInfo method = composite_method(composite.name, detector, namer);
  method.origin = fmt::format("{} detects, {} names", detector.name, namer.name);
  method.fingerprint = fmt::format("{} [{}] [{}]", method.origin, detector.fingerprint, namer.fingerprint);
  return method;
}

}  // namespace

MethodPrograms take_method_files(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  std::vector<MethodProgram> composites;  // may use methods that follow in the files
  const auto table = std::make_shared<MethodTable>();
  for (const std::string& file : files)
    for (MethodProgram& program : load_method_file(file)) {
      names.push_back(program.name);
      if (program.detector.empty())
        table->add(method_of_program(program));
      else
        composites.push_back(std::move(program));
    }
  for (const MethodProgram& composite : composites)
    table->add(method_of_composite(composite, *table));
  return {names, table};
}

std::map<std::string, std::string, std::less<>> threshold_options(const std::vector<std::string>& files) {
  std::map<std::string, std::string, std::less<>> options;
  for (const std::string& file : files)
    for (const MethodProgram& program : load_method_file(file))
      if (!program.threshold_option.empty())
        options[program.name] = program.threshold_option;
  return options;
}

std::vector<std::string> with_programs(const std::vector<std::string>& named,
                                       const std::vector<std::string>& own,
                                       const std::vector<std::string>& programs) {
  if (programs.empty())
    return named;
  std::vector<std::string> methods = named.empty() ? own : named;
  if (methods == std::vector<std::string>{"all"})  // includes the programs
    return methods;
  for (const std::string& program : programs)
    if (std::find(methods.begin(), methods.end(), program) == methods.end())
      methods.push_back(program);
  return methods;
}

void add_part_of(CLI::App& app, std::string& shard, const std::string& what) {
  add_part_option(app, "--shard", shard, "I/N, auto or auto/N",
                  fmt::format("Do part I/N of the {}: every Nth, from the Ith on; auto and auto/N as for "
                              "`run`. Without it, the command does the rest and shows everything",
                              what));
}

void add_shard_interval(CLI::App& app, double& interval) {
  app.add_option(
         "--shard-interval", interval,
         "Seconds between saves of finished experiments; a killed run loses at most the work of this time")
      ->check(number_between(0.0, 1e9))
      ->capture_default_str();
}

std::optional<PartNumber> part_of_option(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(parse_part(text, process_environment));
}

void add_overwrite(CLI::App& app, bool& overwrite) {
  app.add_flag("--overwrite", overwrite,
               "Replace any existing file; without it, the command refuses to replace the archive of another "
               "study or seed");
}

void add_fresh(CLI::App& app, bool& fresh) {
  app.add_flag("--fresh", fresh, "Run all loops, also those in the cache");
}

void add_full(CLI::App& app, bool& full) {
  app.add_flag("--full", full, "All tables, not only the first one");
}

void add_json(CLI::App& app, bool& json) {
  app.add_flag("--json", json, "Print JSON");
}

CLI::Option* add_quiet(CLI::App& app, bool& quiet, const std::string& description) {
  return app.add_flag("--quiet", quiet, description);
}

}  // namespace mpm
