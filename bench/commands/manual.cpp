#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "analysis/study_files/study_file_keys.hpp"
#include "bench/commands/commands.hpp"
#include "bench/console/manual_page.hpp"
#include "bench/console/output.hpp"
#include "bench/version.hpp"
#include "results/gates/gate_file.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {

namespace {

/// The tables of docs/ that are made from declarations, in Markdown, by the names that they have there.
nlohmann::ordered_json manual_tables() {
  nlohmann::ordered_json tables;
  const auto add = [&tables](const std::string& file, const std::vector<KeyTable>& of_file) {
    for (const KeyTable& table : of_file)
      tables[table.name.empty() ? file : file + ' ' + table.name] = manual_table(table.keys);
  };
  add("study", study_file_tables());
  add("gates", gate_file_tables());
  return tables;
}

}  // namespace

void add_manual(CommandSet& commands) {
  const auto tables = std::make_shared<bool>(false);
  CLI::App& app = commands.add("manual", "Print the manual page, for man", [&commands, tables] {
    print_result(*tables ? manual_tables().dump(1) + '\n'
                         : manual_page(commands.program(), mpmbench_version()));
    return ExitCode::done;
  });
  app.add_flag("--tables", *tables)->group("");  // for tests/bench/check_manual_tables.py
}

void add_completion(CommandSet& commands) {
  commands.add("completion",
               "Print the completion of commands and options for bash: source <(mpmbench completion)",
               [&commands] {
                 print_result(bash_completion(commands.program()));
                 return ExitCode::done;
               });
}

}  // namespace mpm
