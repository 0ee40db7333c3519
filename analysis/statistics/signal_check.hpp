#pragma once

#include <string>

#include <Eigen/Core>

namespace mpm {

/// Refuses a signal that is shorter than `shortest` samples or holds a value that is not finite.
/// @throws InputError naming the signal, what was found and what is allowed
void require_signal(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& signal,
                    Eigen::Index shortest);

/// Refuses two signals of different lengths.
/// @throws InputError naming both
void require_same_length(const std::string& name_a, const Eigen::Ref<const Eigen::VectorXd>& a,
                         const std::string& name_b, const Eigen::Ref<const Eigen::VectorXd>& b);

/// Refuses a confidence level outside (0, 1).
/// @throws InputError naming the level found
void require_confidence(double confidence);

/// Returns whether all values are the same. Their computed mean need not equal that value: its rounding error
/// grows with the length and may, beyond some hundred samples, exceed what `variance_floor` allows.
bool stands_still(const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Returns the largest variance that rounding alone can give a constant signal: (4 eps max|x|)^2, with eps =
/// 2.2e-16. A variance up to this floor counts as zero throughout the analysis.
double variance_floor(const Eigen::Ref<const Eigen::VectorXd>& signal);

}  // namespace mpm
