#pragma once

#include <cstdint>

namespace mpm {

/// t with P(|T| <= t) = `confidence` for T of Student's distribution with `freedom` > 0 degrees of freedom.
/// @throws InputError unless 0 < confidence < 1
double two_sided_student_quantile(double confidence, std::int64_t freedom);

/// t with P(T <= t) = `probability` of the same distribution.
double student_quantile(double probability, double freedom);

/// P(T >= t) of the same distribution.
double student_upper_tail(double t, std::int64_t freedom);

}  // namespace mpm
