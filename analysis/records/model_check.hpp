#pragma once

#include <memory>
#include <vector>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/records/channel_error_fit.hpp"

namespace mpm {

inline constexpr const char* kModelCheck = "model-error";
/// Numbers that a RecordPanel adds to its answers, CvCost::ratio of each CV.
inline constexpr const char* kCostNumber = "cost";
inline constexpr const char* kCostSinceNumber = "cost_since";

/// The largest input_dependence() of a CV.
inline constexpr const char* kFitNumber = "fit";

/// Without simulated records, a score above this is flagged. The largest score of 26 healthy records
/// (tests/reliability/records.py, seeds 2 and 3) was 1.16.
inline constexpr double kFarTooLarge = 1.5;

/// The method that checks whether the model explains the record as well as a model that is some percent off.
/// ChannelErrorFit has the errors a of the channels of CV i, the mean square `left` of what they leave of the
/// simulation errors, and the noise v_i. With them,
///
///   score_i = max(max |a| / 2, sqrt(left / v_i))
///
/// So both a channel that is further off and errors that no channel explains raise the score; without either
/// it is about 1. With a benchmark period of the record, errors that it already shows are the plant's habit:
/// a, left and v_i are those beyond the habit (ModelHabit), over the samples outside of the period. The
/// controller plays no part in the score. Only `assess` has this method: it knows `delta`, and its threshold
/// comes from the simulated records. With delta = 0 the model is exact.
AssessmentMethodInfo model_check_method(double delta);

/// The habit that the benchmark of this context shows if it is a period of a record; null: it is a nominal
/// loop, or the model is exact (`delta` = 0).
std::shared_ptr<const ModelHabit> record_habit(const AssessmentContext& context, double delta);

/// A CV whose noise differs from that of the study.
struct UnexplainedCv {
  Eigen::Index cv;
  double noise;  ///< its standard deviation, over the one that the study states
};

inline constexpr double kMostNoise = 10.0;  ///< of a CV, over the standard deviation that the study states

/// Returns the CVs that the model does not explain, whatever its errors: it leaves more than half of their
/// variance, and their noise has more than ten times the standard deviation that the study states. The score
/// above cannot show this, since it is relative to the noise of the record. Noise that the habit already has
/// counts as stated; null: there is no habit.
std::vector<UnexplainedCv> unexplained_cvs(const Study& study, const AssessedLoop& loop, double delta,
                                           const ModelHabit* habit = nullptr);

}  // namespace mpm
