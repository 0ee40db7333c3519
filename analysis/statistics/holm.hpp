#pragma once

#include <span>
#include <vector>

namespace mpm {

/// Returns Holm's adjusted p-values (Holm 1979), in the order of `p`: with p_(1) <= ... <= p_(m),
///
///   adjusted_(i) = min(1, max over j <= i of (m - j + 1) p_(j))
///
/// If you reject the hypotheses whose adjusted value is at most alpha, the probability of one or more wrong
/// rejections is at most alpha. This holds for any dependence between the tests, which matters here because
/// pairs of methods share methods and loops.
/// @throws InputError for a value outside [0, 1]
std::vector<double> holm_adjusted(std::span<const double> p);

}  // namespace mpm
