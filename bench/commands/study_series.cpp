#include "bench/commands/study_series.hpp"

#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "bench/campaign/campaign_loops.hpp"
#include "bench/console/output.hpp"
#include "bench/files/output_file.hpp"
#include "bench/files/replaced_archive.hpp"

namespace mpm {

void require_archives(const std::vector<IntendedStudy>& studies, const std::filesystem::path& folder,
                      const RunOptions& options, bool overwrite) {
  make_output_folder(folder, "archives");
  for (const IntendedStudy& study : studies) {
    require_output_archive(study.archive, "archive");
    if (!overwrite)
      require_replaceable(study.archive, study_to_run(study.study, options), Unreadable::replaced);
  }
}

void run_series(const std::vector<IntendedStudy>& studies, const RunOptions& options, Progress& progress,
                const std::string& output, const std::string& command_line, const TakeRun& take) {
  const auto loops = [&options](const IntendedStudy& study) {
    return options.experiments.value_or(study.study.experiment_count()) + calibration_loops(study.study);
  };
  std::int64_t later =
      std::accumulate(studies.begin(), studies.end(), std::int64_t{0},
                      [&loops](std::int64_t sum, const IntendedStudy& study) { return sum + loops(study); });
  for (std::size_t place = 0; place < studies.size(); ++place) {
    const IntendedStudy& study = studies[place];
    const std::string name = fmt::format("{}: {}", study.place, study.name);
    later -= loops(study);
    progress.plan(later);
    try {
      KeptRun run =
          run_unless_kept(study.archive, study.study, options, hooks_of(progress), command_line,
                          [&](bool is_there) { progress.note(name + (is_there ? ", done already" : "")); });
      if (!run.trouble.empty())
        progress.warn(fmt::format("{}: {}", name, run.trouble));
      take(place, std::move(run));
    } catch (const Interrupted& error) {
      throw std::runtime_error(fmt::format("{}, in {}{}", progress.explain(error), name,
                                           how_to_go_on("in " + output, command_line)));
    }
  }
}

}  // namespace mpm
