#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>

#include "analysis/study_files/study_library.hpp"
#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"
#include "results/records/netcdf_columns.hpp"

namespace mpm {
namespace {

/// Whether a file is an archive. Does not open a pipe: what is read from it would be lost.
bool is_archive(const std::string& file) {
  std::error_code no_status;
  if (!std::filesystem::is_regular_file(file, no_status))
    return false;
  std::string start(8, '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  return is_hdf5(start);
}

ExitCode show(const std::string& study) {
  print_result(is_archive(study) ? stream_input(study).study.source : find_study(study).source);
  return ExitCode::done;
}

}  // namespace

void add_show(CommandSet& commands) {
  const auto study = std::make_shared<std::string>();
  CLI::App& app =
      commands.add("show", "Print the text of a study, to copy and change", [study] { return show(*study); });
  add_path(app, "STUDY", *study,
           "Name of a shipped study, study file, - for stdin, or an archive: the study that it ran")
      ->required();
}

}  // namespace mpm
