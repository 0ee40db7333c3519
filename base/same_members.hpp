#pragma once

#include <cmath>
#include <tuple>

#include <Eigen/Core>

// Equality of structures that a defaulted operator== cannot compare: Eigen's == asks for vectors of one
// length, and no NaN equals itself, though it stands for "none" in some members.

namespace mpm {

template <class Value>
bool same(const Value& a, const Value& b) {
  return a == b;
}
/// NaN is the same as NaN.
inline bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}
/// Vectors of different lengths differ.
inline bool same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && a == b;
}

/// Are all members the same, one by one? The tuples are made of structured bindings, which do not compile
/// when a member is added to the structure and not to them.
template <class... Members>
bool same_members(const std::tuple<Members...>& a, const std::tuple<Members...>& b) {
  return std::apply(
      [&b](const auto&... of_a) {
        return std::apply([&](const auto&... of_b) { return (same(of_a, of_b) && ...); }, b);
      },
      a);
}

}  // namespace mpm
