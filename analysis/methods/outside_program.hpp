#pragma once

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/method_file.hpp"

namespace mpm {

/// A method that is a program. As long as the method lives, each thread or worker process has one child
/// process of its own. The child receives a context and then one loop after another, as lines of JSON, and a
/// new context when the context changes (docs/bring_your_own.md). If a child ends, does not answer in time,
/// or answers what cannot be read, the verdict on its loop is `failed`, and the next loop gets a new child.
/// If a child was killed from outside, or cannot be started for lack of files or processes, there is no
/// verdict: this error passes through assess() (is_of_surroundings()). An answer with the number of an
/// earlier message is skipped: the first one counts.
///
/// The program is started once for its description. Throws InputError if it gives no valid description.
AssessmentMethodInfo program_method(const MethodProgram& program);

}  // namespace mpm
