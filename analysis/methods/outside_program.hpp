#pragma once

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/method_file.hpp"

namespace mpm {

/// A method that is a program. Each thread or worker process has one child process of its own as long as the
/// method lives, which receives a context and then one loop after another as lines of JSON, and where the
/// context changes the new one (docs/bring_your_own.md). If a child ends,
/// does not answer in time, or answers what cannot be read, the verdict on its loop is `failed`, and the next
/// loop has a new child; a child that was killed from outside, or that cannot be started for lack of files or
/// processes, has no verdict: this error passes through assess() (is_of_surroundings()). An answer with the
/// number of an earlier message is skipped: the first one counts.
///
/// The program is started once, for its description. Throws InputError when that is none.
AssessmentMethodInfo program_method(const MethodProgram& program);

}  // namespace mpm
