#include "scenarios/files/resolved_study.hpp"

#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include "plants/error.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_draft.hpp"

namespace mpm {

namespace {

TomlDraft resolved_draft(const Study& study) {
  TomlDraft draft(study_file_keys(""));
  Study read = read_study(study.source, study.name, &draft);
  read.seed = study.seed;
  read.methods = study.methods;
  if (read != study)
    throw InputError(fmt::format("defaults of the study '{}'", study.name),
                     "a study that was changed after it was read",
                     "a study as its text says it, with any seed and methods");
  TomlDraft& heading = draft.table("study", study_file_keys("study"));
  constexpr std::int64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();
  if (study.seed <= static_cast<std::uint64_t>(kLargestSeed))
    heading.set("seed", static_cast<std::int64_t>(study.seed));
  else
    heading.comment("seed", fmt::format("{}, above what a study file can say, {}", study.seed, kLargestSeed));
  draft.table("methods", study_file_keys("methods")).set("names", study.methods);
  return draft;
}

}  // namespace

std::string resolved_study(const Study& study) {
  return resolved_draft(study).text();
}

std::vector<std::string> changed_defaults(const Study& study) {
  return resolved_draft(study).changes();
}

}  // namespace mpm
