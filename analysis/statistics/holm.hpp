#pragma once

#include <span>
#include <vector>

namespace mpm {

/// Holm's adjusted p-values (Holm 1979), in the order of `p`: with p_(1) <= ... <= p_(m),
///
///   adjusted_(i) = min(1, max over j <= i of (m - j + 1) p_(j))
///
/// To reject the hypotheses whose adjusted value is at most alpha keeps the probability of a single wrong
/// rejection at alpha or below, whatever the dependence between the tests: pairs of methods share methods and
/// loops.
/// @throws InputError for a value outside [0, 1]
std::vector<double> holm_adjusted(std::span<const double> p);

}  // namespace mpm
