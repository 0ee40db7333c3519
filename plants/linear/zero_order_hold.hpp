#pragma once

#include <Eigen/Core>

#include "plants/linear/transfer_function.hpp"
#include "plants/output_sampling.hpp"

namespace mpm {

/// Largest dead time, in samples, that a discrete channel can have.
inline constexpr int kMaxDelay = 1'000'000;

/// A sampled channel, whose input is held constant between samples.
///
///   x(k+1) = A x(k) + b_now u(k - delay) + b_previous u(k - delay - 1)
///   y(k)   = c x(k) + d u(k - delay - 1) + sum_i step_i (u(k - i) - u(k - i - 1)),   i = 1, ..., m
///
/// u(k) acts on [k Ts, (k+1) Ts), and y(k) is sampled just before the input changes to u(k). Hence y(k)
/// depends only on inputs before sample k, even if d != 0 and there is no dead time.
///
/// | symbol     | meaning                                      | shape | unit              |
/// |------------|----------------------------------------------|-------|-------------------|
/// | A          | transition over one sample                   | n x n | 1                 |
/// | b_now      | effect of the newer of the two inputs        | n     | 1 / unit of u     |
/// | b_previous | effect of the older one; 0 for whole delays  | n     | 1 / unit of u     |
/// | c, d       | output row, direct effect                    | n, 1  | unit of y         |
/// | delay      | whole samples of dead time                   | 1     | samples           |
/// | step       | step response beside the states; it stays at | m     | unit of y         |
/// |            | its last value; only with coefficients       |       |                   |
struct DiscreteChannel {
  Eigen::MatrixXd A;
  Eigen::VectorXd b_now;
  Eigen::VectorXd b_previous;
  Eigen::RowVectorXd c;
  double d = 0;
  int delay = 0;
  Eigen::VectorXd step = {};
};

/// Errors: InputError unless `sample_time` is finite and > 0.
void require_sample_time(double sample_time);

/// The exact zero-order-hold equivalent of a channel at a sample time Ts. With x' = A_c x + B u a realisation
/// of the rational part and theta = delay Ts + eps, 0 <= eps < Ts,
///
///   A = e^{A_c Ts},   b_now = int_0^{Ts - eps} e^{A_c s} ds B,
///   b_previous = int_{Ts - eps}^{Ts} e^{A_c s} ds B.
///
/// The integrals come from the exponential of the augmented matrix [A_c B; 0 0] (Van Loan 1978), so that
/// integrators and repeated poles need no special case. Behind a washout, the result is the equivalent of the
/// channel and the filter of its samples together. A dead time within a relative 1e-9 of a whole number of
/// samples counts as whole (27 / 0.1 is not 270 in floating point).
///
/// A channel that has the coefficients of its step response S(t) is modelled by them alone,
/// step_i = S(i Ts). This is exact for straight lines between coefficients, and also for the coefficients
/// themselves if Ts is their interval. The only state is that of the ramp after the coefficients,
/// x(k+1) = x(k) + Ts rate u(k - m), or of the washout.
///
/// With OutputSampling::average y(k) is the mean of the response over the sample time before sample k. The
/// mean is one more state m, with y = m, and as exact as the others: the integral q' = C x + D u of the
/// output is added to x in the augmented matrix,
///
///   [A_c 0 B; C 0 D; 0 0 0],   m(k+1) = (q((k+1) Ts) - q(k Ts)) / Ts.
///
/// For coefficients, the means of S(t) take the place of S(i Ts).
///
/// Errors: InputError unless `sample_time` (same unit as the time constants) is finite and > 0, dead time and
/// coefficients span at most kMaxDelay samples, and the result is finite (a fast unstable pole overflows).
/// Also for averages behind a washout, which is a filter of samples.
DiscreteChannel discretise(const TransferFunction& channel, double sample_time,
                           OutputSampling sampling = OutputSampling::snapshot);

}  // namespace mpm
