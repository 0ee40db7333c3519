#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "analysis/study_files/study_library.hpp"
#include "bench/commands/commands.hpp"
#include "bench/console/output.hpp"

namespace mpm {
namespace {

ExitCode list() {
  const std::vector<StudyEntry> studies = shipped_studies();
  std::size_t width = 0;
  for (const StudyEntry& study : studies)
    width = std::max(width, study.name.size());
  for (const StudyEntry& study : studies)
    print_result(fmt::format("{:<{}}  {}\n", study.name, width, study.title));
  return ExitCode::done;
}

}  // namespace

void add_list(CommandSet& commands) {
  commands.add("list", "List the shipped studies", list);
}

}  // namespace mpm
