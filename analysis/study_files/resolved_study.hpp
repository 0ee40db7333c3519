#pragma once

#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// The study as the text of a study file with every default written out, in the order of docs/study_file.md.
///
/// What is written is what the reader of study files takes from `study.source`, value by value, so
/// parse_study() makes the same study of it. A key has no place in it where nothing stands for it, such as
/// `sensitivity.active_cvs` of a study that leaves the choice to the basis case, or has no meaning for this
/// study, such as `mismatch` in one of named scenarios.
///
/// Seed and methods are those of `study`, which may differ from those in its source: a run can have its own.
/// A seed above 2^63 - 1, which no study file can have, is written as a comment: the text then is no study
/// until it has a seed.
///
/// Errors: InputError when `study` differs in anything else from what its source says.
std::string resolved_study(const Study& study);

/// The same without keys that came after the boards that ship, where they have their defaults: the text of a
/// study that means what it meant stays as it was, so that its digest does. Errors: as resolved_study().
std::string lasting_text(const Study& study);

/// What of this study is not as its defaults would have it, for people: "diagnosis.mpm_threshold = 0.2
/// (default: 0.1)". Keys without a default are not among them. Errors: as resolved_study().
std::vector<std::string> changed_defaults(const Study& study);

}  // namespace mpm
