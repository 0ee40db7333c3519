#include "bench/command_report.hpp"

#include <span>

#include <fmt/format.h>

#include "bench/files.hpp"
#include "results/files/atomic_file.hpp"
#include "results/report/report.hpp"

namespace mpm {

ExitCode report(const ReportCommand& command) {
  const FigureFormat format = figure_format(command.format);
  if (!command.output.empty())
    require_output_folder(command.output, "page");
  const Campaign campaign = read_input(command.archive);
  if (!command.output.empty()) {
    const std::string page = report_html(campaign, command.archive);
    write_file_atomically(command.output, std::as_bytes(std::span(page)));
    fmt::print("{}\n", command.output);
  }
  if (!command.figures.empty())
    for (const std::filesystem::path& file : write_figures(campaign, command.figures, format))
      fmt::print("{}\n", file.string());
  return ExitCode::done;
}

}  // namespace mpm
