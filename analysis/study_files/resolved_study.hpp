#pragma once

#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// Returns the study as the text of a study file with every default written out, in the order of
/// docs/study_file.md.
///
/// The text has every value that the reader of study files takes from `study.source`, so parse_study() makes
/// the same study of it. A key is left out if no value expresses its default, such as
/// `sensitivity.active_cvs` of a study that leaves the choice to the basis case, or if it has no meaning for
/// this study, such as `mismatch` in a study of named scenarios.
///
/// Seed and methods are those of `study`, which may differ from those in its source because a run can have
/// its own. A seed above 2^63 - 1, which no study file can have, is written as a comment; the text is then
/// not a valid study until it has a seed.
///
/// Errors: InputError if `study` differs from its source in anything else.
std::string resolved_study(const Study& study);

/// Returns resolved_study() without the keys that are newer than the shipped boards and have their defaults.
/// A study whose meaning has not changed thus keeps its text and therefore its digest. Errors: as
/// resolved_study().
std::string lasting_text(const Study& study);

/// Lists the keys of this study that differ from their defaults, for people: "diagnosis.mpm_threshold = 0.2
/// (default: 0.1)". Keys without a default are not listed. Errors: as resolved_study().
std::vector<std::string> changed_defaults(const Study& study);

}  // namespace mpm
