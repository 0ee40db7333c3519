#pragma once

#include <cstdint>

namespace mpm {

/// Returns the t with P(|T| <= t) = `confidence`, where T has Student's distribution with `freedom` > 0
/// degrees of freedom.
/// @throws InputError unless 0 < confidence < 1
double two_sided_student_quantile(double confidence, std::int64_t freedom);

/// Returns the t with P(T <= t) = `probability` for the same distribution.
double student_quantile(double probability, double freedom);

/// Returns P(T >= t) for the same distribution.
double student_upper_tail(double t, std::int64_t freedom);

}  // namespace mpm
