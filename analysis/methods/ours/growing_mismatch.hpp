#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/ours/disturbance_scan.hpp"
#include "analysis/methods/ours/mismatch_responses.hpp"
#include "analysis/statistics/truncated_normal.hpp"

namespace mpm {

/// The evidence for a mismatch that begins within the record and grows along a line until it is whole.
struct GrowingMismatch {
  std::size_t mismatch;  ///< its place among the responses
  TruncatedNormal size;  ///< the posterior of its size, with the evidence as its mass
  double best_size;
  double onset, end;      ///< samples: its onset, and the end of its growth
  double log_likelihood;  ///< at the best size, onset and end
};

/// The directions of what is unknown about the model if this part (N) of a mismatch (its place, its size) is
/// present at each sample, q x N in standard deviations of the noise.
using DirectionsOfGrowing =
    std::function<Eigen::MatrixXd(std::size_t mismatch, double size, const Eigen::RowVectorXd& part)>;

/// The explanation of the simulation error of a CV by a mismatch that grows,
///
///   e = m(theta, r) + Z' z + n,   r(k) = 0 before the onset, 1 from the end on, a line between.
///
/// m(theta, r) is the response to a mismatch of which the share r(k) is present at sample k, as in
/// ChangingPlant: a gain changes at the input, anything else at the output. The evidence is the integral over
/// size, onset and end by Laplace's method. The onset is uniform over the record, the growth uniform up to
/// its length. Onsets of a coarse grid are tried for every parameter; the best few are refined by Gauss and
/// Newton, at first with the Z of a healthy model, and then with `directions`.
///
/// | symbol | name      | shape         | unit                             |
/// |--------|-----------|---------------|----------------------------------|
/// | e, Z   | series    | (1 + q) x N   | standard deviations of the noise |
/// | m      | responses | one a mismatch |                                 |
/// | u      | inputs    | (nu + nd) x N |                                  |
std::vector<GrowingMismatch> growing_mismatches(const BaseNoise& noise, bool starts_from_rest,
                                                const ScaleLikelihood& likelihood,
                                                const std::vector<MismatchResponses>& responses,
                                                const Eigen::Ref<const Eigen::MatrixXd>& series,
                                                const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                                const Eigen::Ref<const Eigen::VectorXd>& initial,
                                                const DirectionsOfGrowing& directions);

}  // namespace mpm
