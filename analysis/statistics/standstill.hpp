#pragma once

#include <Eigen/Core>

namespace mpm {

/// The longest stretch of a signal in which all values that are there are equal.
struct Standstill {
  Eigen::Index first = 0, end = 0;  ///< its first sample and the one after its last; equal: no value
  /// N p^(n - 1), n the values of the stretch, N the length of the signal and p the share of neighbours
  /// outside of it that are equal, (equal + 1) / (neighbours + 2): about the probability that values which
  /// are equal by rounding alone, or because they are held, give such a stretch somewhere.
  double chance = 1.0;

  Eigen::Index length() const { return end - first; }
};

/// NaN is missing.
///
/// | symbol | name   | shape | unit |
/// |--------|--------|-------|------|
/// |        | values | N     | any  |
Standstill longest_standstill(const Eigen::Ref<const Eigen::RowVectorXd>& values);

/// The signal without what stands in it for a while though it does not elsewhere, such as bad values in whose
/// place the last good one was kept: NaN but for the first value of each stretch of n equal ones with
/// N p^(n - 1) < 0.05, p the share of stretches that have more than one value, (such stretches + 1) /
/// (stretches + 2). What is_long() stays: a frozen instrument is no bad value.
Eigen::RowVectorXd without_standstills(Eigen::RowVectorXd values);

/// Is this stretch one of an instrument that may be frozen: 20 samples and a tenth of the signal?
bool is_long(const Standstill& stretch, Eigen::Index samples);

/// Is it, and longer than chance makes it, at a probability of 1e-6: of an instrument that is frozen?
bool is_frozen(const Standstill& stretch, Eigen::Index samples);

}  // namespace mpm
