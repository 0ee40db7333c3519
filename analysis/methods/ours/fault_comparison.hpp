#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "analysis/methods/ours/cv_errors.hpp"
#include "analysis/methods/ours/record_source.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// How well each sort of fault explains the simulation errors of a loop beside noise of any shape, on one
/// scale: the sum of the L of all CVs (CvErrors), less k/2 log N for the k parameters of the hypothesis h
/// (Schwarz 1978) and less log m for the m channels, CVs, or MVs and valve models among which it chooses. The
/// slow part of n is a disturbance, which may be there under each hypothesis.
///
/// | hypothesis  | h                                                                                        |
/// |-------------|------------------------------------------------------------------------------------------|
/// | disturbance | none                                                                                     |
/// | mismatch    | of one channel of each CV: another gain, time constant or dead time, from some sample on |
/// | data        | y is s samples late against the inputs, in one CV or in all: y_sim(k) - y_sim(k - s)     |
/// | sensor      | a ramp or a step in y of one CV from some sample on: of its sensor, or of a disturbance  |
/// | valve       | of one MV: the responses to x - u, x of a StickyValve, or of a FrictionValve without     |
/// |             | kinetic friction                                                                         |
struct FaultLikelihoods {
  double disturbance = 0.0, mismatch = 0.0, data = 0.0, sensor = 0.0, valve = 0.0;  ///< L
  Eigen::Index data_cv = -1;                                                        ///< -1: all CVs
  double late = 0.0;                                                                ///< s
  Eigen::Index sensor_cv = -1, valve_mv = -1;
  bool sensor_jumps = false;                ///< h of `sensor` is a step
  bool sensor_stuck = false;                ///< `sensor_cv` shows one value instead
  std::optional<NamedMismatch> named = {};  ///< the most likely mismatch, if it is of an MV; without a size
  Eigen::Index md = -1;  ///< MD whose channel has the most likely mismatch; -1: an MV's has it
};

/// The hypotheses about one loop.
class FaultComparison {
 public:
  /// `errors` of each CV of the loop. Study and loop must outlive it.
  FaultComparison(const Study& study, const AssessedLoop& loop, std::vector<CvErrors> errors);

  const FaultLikelihoods& likelihoods() const { return found_; }

  /// The largest input_dependence() of a CV after the most likely fault of this source is subtracted; 0 for a
  /// mismatch, whose size is not known here.
  double dependence_beside(RecordSource source) const;

 private:
  const CvErrors& of(Eigen::Index cv) const { return errors_[static_cast<std::size_t>(cv)]; }
  void ask_mismatch();
  void ask_data();
  void ask_sensor();
  void ask_valve();
  double of_valve(Eigen::Index mv, const Eigen::RowVectorXd& x) const;

  const Study& study_;
  const AssessedLoop& loop_;
  std::vector<CvErrors> errors_;
  FaultLikelihoods found_;
  double none_ = 0.0;
  Eigen::RowVectorXd off_;  ///< x - u of the most likely valve
  Eigen::VectorXd drift_;   ///< drift of the most likely sensor, of any size
};

/// Tests whether the inputs help to predict the errors of a CV beside the last twelve errors of every CV
/// (Granger 1969). The controller answers to these errors, so its moves tell nothing more about a
/// disturbance, whatever its shape. Returns the Lagrange multiplier statistic of the last six moves of each
/// input behind its dead time, over the value that chance exceeds in 1 of 100 records. The statistic has the
/// covariance of White (1980), since the size of a disturbance changes. In a short record there are fewer
/// errors of each CV, and a missing error counts as 0. The test is absolute: what no hypothesis explains
/// raises the result above 1.
double input_dependence(const Study& study, const AssessedLoop& loop, const CvErrors& errors,
                        Eigen::Index cv);

/// CVs whose rows are shifted in time against those of the inputs.
struct LateCvs {
  double samples = 0.0;                ///< below 0: early; 0: none is late
  std::vector<Eigen::Index> cvs = {};  ///< empty: all

  bool any() const { return samples != 0.0; }
  bool has(Eigen::Index cv) const {
    return any() && (cvs.empty() || std::find(cvs.begin(), cvs.end(), cv) != cvs.end());
  }
};

/// Finds the CVs that are late against the inputs (below 0: early), all by the same shift s of half or whole
/// samples; none if nobody can tell. A CV is late if s explains it better than no shift by 2 in L. All CVs
/// are late if s explains none of them worse by 2 in L. Together s must explain the late CVs better than no
/// shift does by 6 in L, with the gain of each channel free in both, and not worse than a mismatch in one
/// channel of each CV does; a single late CV among several must be explained better than that by 6.
LateCvs common_lateness(const Study& study, const AssessedLoop& loop, const std::vector<CvErrors>& errors);

}  // namespace mpm
