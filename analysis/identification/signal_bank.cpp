#include "analysis/identification/signal_bank.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <stdexcept>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

using Coefficients = Eigen::Ref<const Eigen::MatrixXd>;

/// The coefficients of the signals of one group: eight numbers per row, with zeros where the group has fewer
/// signals.
LaneMatrix coefficients(const Eigen::Ref<const Eigen::MatrixXd>& polynomials, Eigen::Index group) {
  LaneMatrix rows(8, polynomials.rows());
  const Eigen::Index signals = std::min<Eigen::Index>(8, polynomials.cols() - 8 * group);
  for (Eigen::Index i = 0; i < polynomials.rows(); ++i)
    for (Eigen::Index a = 0; a < signals; ++a)
      rows(a, i) = polynomials(i, 8 * group + a);
  return rows;
}

/// The same for the few rows of `filter_paths`, without an allocation.
struct PathCoefficients {
  alignas(64) double number[8 * (LaneKernels::kPathOrder + 1)] = {};

  PathCoefficients(const Eigen::Ref<const Eigen::MatrixXd>& polynomials, Eigen::Index group) {
    const Eigen::Index signals = std::min<Eigen::Index>(8, polynomials.cols() - 8 * group);
    for (Eigen::Index a = 0; a < signals; ++a)
      for (Eigen::Index i = 0; i < polynomials.rows(); ++i)
        number[8 * i + a] = polynomials(i, 8 * group + a);
  }
};

}  // namespace

SignalBank::SignalBank(Eigen::Index count, Eigen::Index samples, Eigen::Index memory)
    : count_(count),
      samples_(samples),
      memory_(memory),
      memory_of_(static_cast<std::size_t>((count + 7) / 8 * 8 * (memory + samples)), 0.0) {}

void SignalBank::require_memory(Eigen::Index samples) const {
  if (memory_ < samples)
    throw std::logic_error("a bank of signals is read before its memory");
}

void filter_bank(const Eigen::Ref<const Eigen::MatrixXd>& B, const Eigen::Ref<const Eigen::MatrixXd>& F,
                 Eigen::Index delay, const SignalBank& in, SignalBank& out) {
  assert(B.cols() == in.count() && F.cols() == in.count() && out.count() == in.count());
  in.require_memory(B.rows() - 1 + delay);
  out.require_memory(std::max<Eigen::Index>(1, F.rows() - 1));
  for (Eigen::Index group = 0; group < in.groups(); ++group) {
    const LaneMatrix numerators = coefficients(B, group);
    const LaneMatrix denominators = coefficients(F, group);
    lane_kernels().filter_eight(numerators.data(), B.rows(), denominators.data(), F.rows() - 1,
                                in.at(group, -delay), in.samples(), out.at(group, 0));
  }
}

void filter_paths(const Eigen::Ref<const Eigen::MatrixXd>& F1, const Eigen::Ref<const Eigen::MatrixXd>& B,
                  const Eigen::MatrixXd* F2, const SignalBank& x, SignalBank& path, SignalBank& out) {
  assert(F1.rows() == B.rows() && F1.rows() > 1 && (F2 == nullptr || F2->rows() == B.rows()));
  const Eigen::Index order = F1.rows() - 1;
  if (order > LaneKernels::kPathOrder) {
    const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, x.count());
    filter_bank(one, F1, 0, x, out);
    filter_bank(B, one, 0, out, path);
    if (F2 != nullptr)
      filter_bank(one, *F2, 0, path, out);
    return;
  }
  for (Eigen::Index group = 0; group < x.groups(); ++group) {
    const PathCoefficients first(F1, group), numerators(B, group),
        second(F2 == nullptr ? F1 : Coefficients(*F2), group);
    lane_kernels().filter_paths(first.number, numerators.number, F2 == nullptr ? nullptr : second.number,
                                order, x.at(group, 0), x.samples(), path.at(group, 0), out.at(group, 0));
  }
}

}  // namespace mpm
