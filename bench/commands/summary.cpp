#include "results/summary/summary.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "bench/commands/commands.hpp"
#include "bench/commands/common_options.hpp"
#include "bench/console/output.hpp"
#include "bench/files/archive_input.hpp"

namespace mpm {
namespace {

struct SummaryArguments {
  std::string archive;
  bool json = false;
};

ExitCode summary(const SummaryArguments& options) {
  const Campaign campaign = read_input(options.archive);
  const StudyFindings findings = findings_of(campaign);
  print_result(options.json ? summary_json(campaign, findings)
                            : summary_text(campaign, findings, options.archive));
  return ExitCode::done;
}

}  // namespace

void add_summary(CommandSet& commands) {
  const auto options = std::make_shared<SummaryArguments>();
  CLI::App& app = commands.add("summary", "Print what a study found, beside what was reported",
                               [options] { return summary(*options); });
  add_archive(app, options->archive);
  add_json(app, options->json);
}

}  // namespace mpm
