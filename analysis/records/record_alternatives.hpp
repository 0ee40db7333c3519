#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// How well each sort of fault explains the simulation errors of a record, on one scale. With e_i = y - y_sim
/// of CV i without what no record can tell (AssessedLoop::untold), X_i the responses to errors of a healthy
/// model (ChannelErrorFit), E_i the errors of the other CVs in up to six samples before (those above i also
/// in the same sample), and n an autoregression of order 6,
///
///   e_i = h_i + X_i a_i + E_i b_i + n_i,   a_i ~ N(0, I),   b_i of any size
///   L = sum_i (-N/2 log s_i^2 - |a_i|^2 / 2) - k/2 log N
///
/// s_i^2 the mean square of the innovations, k the parameters of the hypothesis (Schwarz 1978). The slow part
/// of n is a disturbance, which may be there in each of them; E_i has one that reaches several CVs, such as
/// that of an MV. From some sample of each CV on, the same for all hypotheses, n may be another
/// autoregression, where that brings more than its k/2 log N.
///
/// | hypothesis  | h                                                                                        |
/// |-------------|------------------------------------------------------------------------------------------|
/// | disturbance | none                                                                                     |
/// | mismatch    | of one channel of each CV: another gain, time constant or dead time, from the onset on   |
/// | data        | y is s samples late against the inputs, in one CV or in all: y_sim(k) - y_sim(k - s)     |
/// | sensor      | a ramp in y of one CV from some sample on: of its sensor, or of a disturbance on it      |
/// | valve       | of one MV: the responses to x - u, x of a StickyValve, or of a FrictionValve without     |
/// |             | kinetic friction                                                                         |
struct RecordAlternatives {
  double disturbance = 0.0, mismatch = 0.0, data = 0.0, sensor = 0.0, valve = 0.0;  ///< L
  Eigen::Index data_cv = -1;                                                        ///< -1: all CVs
  double late = 0.0;                                                                ///< s
  Eigen::Index sensor_cv = -1, valve_mv = -1;
  std::optional<NamedMismatch> named = {};  ///< the most likely mismatch, without a size; none: that of an MD
  OfSources fit = {};  ///< the largest input_dependence() of a CV where this is taken off; none of a mismatch
};

/// `delta`: the errors of the model, 0: none. Throws InputError as ChannelErrorFits.
RecordAlternatives record_alternatives(const Study& study, const AssessedLoop& loop, double delta,
                                       const std::optional<FaultOnset>& onset);

/// Do the inputs help to predict the errors of a CV beside the last twelve errors of every CV (Granger 1969)?
/// The controller answers to these, so that its moves say nothing more of a disturbance, whatever its shape.
/// The Lagrange multiplier statistic of the last six moves of each input behind its dead time, with the
/// covariance of White (1980), since the size of a disturbance changes, over the value that chance exceeds in
/// 1 of 100 records. A short record has fewer errors of each CV, and an error that is missing counts as 0. An
/// absolute test: what no hypothesis explains raises it above 1.
double input_dependence(const Study& study, const AssessedLoop& loop, const ChannelErrorFit& fit,
                        Eigen::Index cv);

/// CVs whose rows are of another time than those of the inputs.
struct LateCvs {
  double samples = 0.0;                ///< below 0: early; 0: none is late
  std::vector<Eigen::Index> cvs = {};  ///< empty: all

  bool any() const { return samples != 0.0; }
  bool has(Eigen::Index cv) const {
    return any() && (cvs.empty() || std::find(cvs.begin(), cvs.end(), cv) != cvs.end());
  }
};

/// The CVs that are late against the inputs (below 0: early), all by the same half or whole samples; none, as
/// far as anyone can tell. Those are late that s explains better than no shift, and all are unless s explains
/// some worse, by 2 in L. Together s explains them better than none does, by 6 in L, where the gain of each
/// channel is free in both, and not worse than a mismatch in one channel of each CV; of one CV alone better
/// by 6 than that.
LateCvs common_lateness(const Study& study, const AssessedLoop& loop, double delta);

}  // namespace mpm
