#pragma once

#include <Eigen/Core>

namespace mpm {

/// The longest stretch of a signal in which all values are equal. Samples in it may be missing.
struct Standstill {
  Eigen::Index first = 0,
               end = 0;  ///< its first sample and the one after its last; equal if there is no value
  /// N p^(n - 1), where n is the number of values in the stretch, N the length of the signal and p the share
  /// of neighbours outside of the stretch that are equal, (equal + 1) / (neighbours + 2). It is about the
  /// probability that such a stretch occurs somewhere if values are equal only because they are rounded or
  /// held.
  double chance = 1.0;

  Eigen::Index length() const { return end - first; }
};

/// Returns the longest standstill of a signal, in which NaN is a missing sample.
///
/// | symbol | name   | shape | unit |
/// |--------|--------|-------|------|
/// |        | values | N     | any  |
Standstill longest_standstill(const Eigen::Ref<const Eigen::RowVectorXd>& values);

/// Returns the signal without the stretches in which it stands still by more than chance, for instance
/// because bad values were replaced by the last good one. In each stretch of n equal values with N p^(n - 1)
/// < 0.05, all values but the first become NaN. p is the share of stretches that have more than one value,
/// (such stretches + 1) / (stretches + 2). A stretch that is_long() stays: a frozen instrument is not a bad
/// value.
Eigen::RowVectorXd without_standstills(Eigen::RowVectorXd values);

/// Returns whether the stretch is so long that the instrument may be frozen: more than 20 samples and more
/// than a tenth of the signal.
bool is_long(const Standstill& stretch, Eigen::Index samples);

/// Returns whether the instrument is frozen: the stretch is_long(), and its `chance` is below 1e-6.
bool is_frozen(const Standstill& stretch, Eigen::Index samples);

}  // namespace mpm
