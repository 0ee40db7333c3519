#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/files/archive_input.hpp"
#include "bench/files/output_file.hpp"
#include "plants/error.hpp"
#include "results/archive/csv_table.hpp"

namespace mpm {
namespace {

struct ExportArguments {
  std::string archive;
  std::string table = "experiments";
  std::optional<std::int64_t> index;  ///< of the experiment; all without
  std::string output;                 ///< stdout when empty
};

ExitCode export_table(const ExportArguments& options) {
  if (!options.output.empty())
    require_output_folder(options.output, "table");
  if (options.index && options.table == "findings")
    throw InputError("--index", "the table findings", "a table with a row or more for each experiment");
  Campaign campaign = read_input(options.archive);
  if (options.index)
    campaign.records = {experiment_of(campaign, *options.index)};
  const std::string table = csv_table(campaign, options.table);
  if (options.output.empty())
    fmt::print("{}", table);
  else
    write_text(options.output, table);
  return ExitCode::done;
}

}  // namespace

void add_export(CommandSet& commands) {
  const auto options = std::make_shared<ExportArguments>();
  CLI::App& app = commands.add("export", "Write a table of an archive as CSV, for Octave and spreadsheets",
                               [options] { return export_table(*options); });
  add_archive(app, options->archive);
  app.add_option("--table", options->table,
                 "experiments, findings, loops (those that were kept), or a method")
      ->capture_default_str();
  app.add_option("--index", options->index, "One experiment only; not of the findings")
      ->check(CLI::NonNegativeNumber);
  app.add_option("-o,--output", options->output, "File to write; stdout without one");
}

}  // namespace mpm
