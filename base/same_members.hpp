#pragma once

#include <cmath>
#include <tuple>

#include <Eigen/Core>

// Equality of structures that a defaulted operator== cannot compare: Eigen's == requires vectors of equal
// length, and NaN does not equal itself, although it stands for "none" in some members.

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

/// Tells whether all members are the same, one by one. The tuples are made of structured bindings: if a
/// member is added to the structure but not to the bindings, the code does not compile.
template <class... Members>
bool same_members(const std::tuple<Members...>& a, const std::tuple<Members...>& b) {
  return std::apply(
      [&b](const auto&... of_a) {
        return std::apply([&](const auto&... of_b) { return (same(of_a, of_b) && ...); }, b);
      },
      a);
}

}  // namespace mpm
