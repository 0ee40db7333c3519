#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/parts/launcher.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace mpm {

class MethodTable;

// Arguments and options that several commands have, each declared once.

/// An option or argument that names a file or a folder, and is not empty.
CLI::Option* add_path(CLI::App& app, const std::string& name, std::string& path,
                      const std::string& description);
/// An option that selects a part of the work, and must not be empty: a shell turns an unset variable into "",
/// which would select all of it.
void add_part_option(CLI::App& app, const std::string& name, std::string& part, const std::string& allowed,
                     const std::string& description);
/// The master seed of a study or a suite.
void add_seed(CLI::App& app, std::optional<std::uint64_t>& seed, const std::string& description,
              std::uint64_t largest = std::numeric_limits<std::uint64_t>::max());
/// --set of a command that runs studies: parse_study_changes().
void add_changes(CLI::App& app, std::vector<std::string>& changes, const std::string& description);
void add_archive(CLI::App& app, std::string& archive);
/// --trust-programs of a command that may simulate loops of what it opens (base/system/program_trust).
void add_trust(CLI::App& app);
void add_index(CLI::App& app, std::int64_t& index);
void add_experiments(CLI::App& app, std::optional<std::int64_t>& experiments, const std::string& description);
/// --jobs (default: the number of cores that this process may use).
void add_jobs(CLI::App& app, int& jobs, const std::string& description);
void add_solver(CLI::App& app, std::string& solver);
/// Names of methods of assessment. The command checks them, since it knows which methods it can take.
void add_methods_option(CLI::App& app, std::vector<std::string>& methods, const std::string& description);
/// Files of methods that are programs (docs/bring_your_own.md).
void add_method_files(CLI::App& app, std::vector<std::string>& files);
/// Methods that are programs, by name, and all methods with them.
struct MethodPrograms {
  std::vector<std::string> names;
  std::shared_ptr<const MethodTable> table;
};
/// Starts each program to get its description. Throws InputError.
MethodPrograms take_method_files(const std::vector<std::string>& files);
/// RunOptions::threshold_options of the methods in these files.
std::map<std::string, std::string, std::less<>> threshold_options(const std::vector<std::string>& files);
/// The methods that assess if `programs` are given: those that the user has `named`, otherwise the `own` ones
/// of the study or suite, and in both cases the programs. Returns `named`, which may be empty, without
/// programs.
std::vector<std::string> with_programs(const std::vector<std::string>& named,
                                       const std::vector<std::string>& own,
                                       const std::vector<std::string>& programs);
/// --shard of a command that runs several studies, `what`: which of them it runs.
void add_part_of(CLI::App& app, std::string& shard, const std::string& what);
/// The value of that option; none without it. Throws InputError.
std::optional<PartNumber> part_of_option(const std::string& text);
void add_shard_interval(CLI::App& app, double& interval);
/// --overwrite of a command that writes archives (require_replaceable()).
void add_overwrite(CLI::App& app, bool& overwrite);
/// --fresh of a command that runs studies whose loops are kept (LoopMemory).
void add_fresh(CLI::App& app, bool& fresh);
/// --full of a command whose text without it is one screen (document_text()).
void add_full(CLI::App& app, bool& full);
void add_json(CLI::App& app, bool& json);
CLI::Option* add_quiet(CLI::App& app, bool& quiet, const std::string& description = "No progress");

}  // namespace mpm
