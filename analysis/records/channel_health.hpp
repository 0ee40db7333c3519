#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "analysis/records/channel_error_fit.hpp"
#include "analysis/records/record_verdict.hpp"
#include "base/enum_words.hpp"
#include "scenarios/faults/fault.hpp"

// The errors of the channels over time: which channel is wrong in which period, and since when something is
// wrong.

namespace mpm {

enum class ChannelState : std::int8_t { good, in_doubt, wrong };
template <>
inline constexpr auto kWords<ChannelState> = word_list("good", "in doubt", "wrong");

/// A channel in a period. Let a be the errors of a fit of this period alone (PartialErrorFit), in standard
/// deviations delta of the errors of a healthy model, C their covariance, and t a threshold of the score:
///
///   score = max |a| / 2 over the parameters of the channel,   wrong: score > t
///   visible = 2 t delta / (1 - C_gg), the error of the gain that reaches t; in doubt: above a half
struct ChannelPeriod {
  ChannelState state = ChannelState::in_doubt;
  double score = 0.0;
  MismatchParameter parameter = MismatchParameter::gain;  ///< the parameter that is furthest off
  double size = 0.0;     ///< its factor, or the shift of a dead time in the time unit of the plant
  double visible = 0.0;  ///< relative
};

/// A channel of the model over all periods.
struct ChannelHistory {
  Eigen::Index cv, input;
  std::vector<ChannelPeriod> periods;
};

/// Returns the first samples of periods of equal length: at most eight periods, each of three settling times
/// or more, or one period if the record is shorter.
std::vector<Eigen::Index> health_periods(Eigen::Index samples, Eigen::Index settling);

/// The histories of the channels of the CV that is fitted; `begins` as returned by health_periods().
std::vector<ChannelHistory> channel_histories(const ChannelErrorFit& fit, Eigen::Index cv,
                                              const std::vector<Eigen::Index>& begins, Eigen::Index samples,
                                              double threshold);

/// Returns since when the errors of a CV differ from those before; none: they did so from the start, or
/// nobody can tell. Each of 60 onsets cuts the record in two: an earlier part with the errors of a healthy
/// model and a later one with errors ten times as large, each with noise of its own. The evidence of both
/// parts is compared with that of errors of either size throughout; beforehand an onset is as probable as
/// none. There is an onset if it has 95 % of the posterior, and if the score of the earlier part is not above
/// the larger of `threshold` and half of the score of the later part.
std::optional<FaultOnset> fault_onset(const ChannelErrorFit& fit, double threshold);

/// The score of the errors of a CV or of a part of them (equation in model_check.hpp).
double error_score(const Eigen::VectorXd& a, double left, double noise);

}  // namespace mpm
