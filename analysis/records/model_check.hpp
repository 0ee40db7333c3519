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

/// A score that is flagged without simulated records. Of 26 healthy records (tests/reliability/records.py,
/// seeds 2 and 3) the largest was 1.16.
inline constexpr double kFarTooLarge = 1.5;

/// Does the model explain the record, as well as a model does that is some percent off? With the errors a of
/// the channels of CV i that ChannelErrorFit has, what they leave of the simulation errors and their noise
/// v_i,
///
///   score_i = max(max |a| / 2, sqrt(left / v_i))
///
/// So both a channel that is further off and errors that no channel explains raise the score; without either
/// it is about 1. With a benchmark period of the record, errors that were there already are the plant's
/// habit: a, left and v_i are those beside it (ModelHabit), over the samples outside of the period. The
/// controller plays no part in it. A method that only `assess` has: it knows `delta`, and its threshold is
/// that of the simulated records. With delta = 0 the model is exact.
AssessmentMethodInfo model_check_method(double delta);

/// The habit that the benchmark of this context shows if it is a period of a record; null: it is a nominal
/// loop, or the model is exact (`delta` = 0).
std::shared_ptr<const ModelHabit> record_habit(const AssessmentContext& context, double delta);

/// A CV whose noise is another than that of its study.
struct UnexplainedCv {
  Eigen::Index cv;
  double noise;  ///< its standard deviation, in those that the study states
};

inline constexpr double kMostNoise = 10.0;  ///< of a CV, in standard deviations that the study states

/// The CVs that the model does not explain, whatever its errors: it leaves more than half of what they do,
/// and their noise has more than ten times the standard deviation that the study states. `score` above cannot
/// say so, since it is relative to the noise of the record. A noise that the habit has (null: there is none)
/// counts as stated.
std::vector<UnexplainedCv> unexplained_cvs(const Study& study, const AssessedLoop& loop, double delta,
                                           const ModelHabit* habit = nullptr);

}  // namespace mpm
