#pragma once

#include "analysis/methods/assessment_method.hpp"
#include "scenarios/files/method_file.hpp"

namespace mpm {

/// A method that is a program: each thread or worker process that assesses has one child of its own, which is
/// told what the method may know (`context`) and then one loop after the other, as lines of JSON
/// (docs/bring_your_own.md). A child that ends, does not answer in time or answers what cannot be read costs
/// the verdict on its loop, which has failed, and the next loop has another child. An answer with the number
/// of an earlier message is passed over: the first one counts.
///
/// The program is started once, for its description. Throws InputError when that is none.
AssessmentMethodInfo program_method(const MethodProgram& program);

}  // namespace mpm
