#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "scenarios/files/study_library.hpp"

namespace mpm {
namespace {

ExitCode show(const std::string& study) {
  print_result(find_study(study).source);
  return ExitCode::done;
}

}  // namespace

void add_show(CommandSet& commands) {
  const auto study = std::make_shared<std::string>();
  CLI::App& app =
      commands.add("show", "Print the text of a study, to copy and change", [study] { return show(*study); });
  add_path(app, "STUDY", *study, "Name of a shipped study, study file, or - for stdin")->required();
}

}  // namespace mpm
