#pragma once

#include <vector>

#include <Eigen/Core>

#include "solvers/lanes/lane_vector.hpp"

namespace mpm {

/// `count` signals of `samples` numbers, eight of them side by side, with `memory` zeros before the first
/// one: for fits that filter them and take products of their shifts again and again.
class SignalBank {
 public:
  using Signal = Eigen::Map<Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<8>>;
  using ConstSignal = Eigen::Map<const Eigen::VectorXd, Eigen::Unaligned, Eigen::InnerStride<8>>;

  SignalBank(Eigen::Index count, Eigen::Index samples, Eigen::Index memory);

  Eigen::Index count() const { return count_; }
  Eigen::Index groups() const { return (count_ + 7) / 8; }
  Eigen::Index samples() const { return samples_; }
  Eigen::Index memory() const { return memory_; }
  Signal operator[](Eigen::Index a) { return {at(a / 8, 0) + a % 8, samples_, Eigen::InnerStride<8>()}; }
  ConstSignal operator[](Eigen::Index a) const {
    return {at(a / 8, 0) + a % 8, samples_, Eigen::InnerStride<8>()};
  }
  /// Throws std::logic_error if the memory has fewer samples, because kernels would read outside of the bank.
  void require_memory(Eigen::Index samples) const;
  /// Sample k, -memory() or later, of the eight signals of a group.
  double* at(Eigen::Index group, Eigen::Index k) { return memory_of_.data() + place(group, k); }
  const double* at(Eigen::Index group, Eigen::Index k) const { return memory_of_.data() + place(group, k); }

 private:
  Eigen::Index place(Eigen::Index group, Eigen::Index k) const {
    return 8 * (group * (memory_ + samples_) + memory_ + k);
  }

  Eigen::Index count_, samples_, memory_;
  LaneMemory memory_of_;
};

/// Passes each signal through its filter q^-delay B/F, from rest: does what `filter` does, for all signals at
/// once.
///
/// | symbol | meaning                                        | shape          |
/// |--------|------------------------------------------------|----------------|
/// | B      | numerators, one column per signal              | nb x count     |
/// | F      | denominators, their first row is taken as 1    | nf + 1 x count |
///
/// `out` may be `in` only if the numerators have one coefficient and there is no delay. The memory of the
/// banks must reach nb - 1 + delay and nf samples back, and at least 1.
void filter_bank(const Eigen::Ref<const Eigen::MatrixXd>& B, const Eigen::Ref<const Eigen::MatrixXd>& F,
                 Eigen::Index delay, const SignalBank& in, SignalBank& out);

/// Passes each signal x through two filters in series, from rest: path = B x/F1, and out = B x/(F1 F2), or
/// out = x/F1 without F2. All polynomials have the same number of rows, 2 or more, and one column per signal.
/// The first rows of F1 and F2 are taken as 1. The memory of the banks must reach as far back as the
/// polynomials.
void filter_paths(const Eigen::Ref<const Eigen::MatrixXd>& F1, const Eigen::Ref<const Eigen::MatrixXd>& B,
                  const Eigen::MatrixXd* F2, const SignalBank& x, SignalBank& path, SignalBank& out);

}  // namespace mpm
