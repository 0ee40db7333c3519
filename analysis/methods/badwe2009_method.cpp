#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/badwe2009.hpp"

namespace mpm {
namespace {

class Badwe2009 final : public AssessmentMethod {
 public:
  explicit Badwe2009(const AssessmentContext& context)
      : controller_(context.study.controller), options_(context.study.assessment.badwe2009) {
    options_.validate();
  }

  Assessment assess(const AssessedLoop& loop) override {
    const Badwe2009Record record = record_of(loop);
    const Eigen::Index needed = samples_needed(record);
    if (loop.samples() < needed)
      return Assessment::not_applicable(
          fmt::format("its models and lags need {} samples, and the record has {}", needed, loop.samples()));
    const Badwe2009Result result = assess_badwe2009(record, options_);
    if (result.status == Badwe2009Status::no_mv)
      return Assessment::failed("no MV is left: all are saturated, stand still or do as the others do");
    return assessment_of(result, loop.y.rows(), loop.u.rows());
  }

 private:
  /// Setpoints of the optimizer follow from the measurements: they come from within the loop.
  Eigen::MatrixXd external_signals(const AssessedLoop& loop) const {
    std::vector<Eigen::Index> cvs;
    for (const Eigen::Index cv : loop.setpoint_cvs())
      if (controller_.has_setpoint(cv))
        cvs.push_back(cv);
    Eigen::MatrixXd signals(static_cast<Eigen::Index>(cvs.size()) + loop.d.rows(), loop.samples());
    if (!cvs.empty())
      signals.topRows(static_cast<Eigen::Index>(cvs.size())) = loop.y_set(cvs, Eigen::all);
    if (loop.d.rows() > 0)
      signals.bottomRows(loop.d.rows()) = loop.d;
    return signals;
  }

  Badwe2009Record record_of(const AssessedLoop& loop) const {
    return {loop.y,
            loop.y_sim,
            loop.u,
            external_signals(loop),
            {controller_.mv_hard.lower, controller_.mv_hard.upper}};
  }

  /// Of `assess_badwe2009`: more samples than coefficients, and four for each lag.
  Eigen::Index samples_needed(const Badwe2009Record& record) const {
    const Eigen::Index inputs = std::max(record.u.rows() - 1, record.external.rows());
    const Eigen::Index each =
        options_.model == DecorrelationModel::fir ? options_.fir_length : options_.nb + options_.nf;
    return std::max<Eigen::Index>(inputs * each + 2, Eigen::Index{4} * options_.max_lag);
  }

  static Assessment assessment_of(const Badwe2009Result& result, Eigen::Index ny, Eigen::Index nu) {
    Assessment assessment;
    assessment.score = 0.0;
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      bool flagged = false;
      double largest = 0.0;
      for (Eigen::Index mv = 0; mv < nu; ++mv) {
        const ChannelAssessment& channel = result.channel(cv, mv);
        const double strength = std::abs(channel.correlation.peak) / channel.correlation.band;
        if (strength > largest)
          largest = strength;
        flagged = flagged || channel.mismatch;
        if (channel.mismatch)
          assessment.flagged_channels.push_back({cv, mv});
        assessment.numbers.push_back({"partial_correlation", channel.correlation.peak, cv, mv});
        assessment.numbers.push_back({"strength", strength, cv, mv});
      }
      assessment.cvs.push_back({flagged, largest, FaultSource::none});
      assessment.flagged = assessment.flagged || flagged;
      assessment.score = std::max(assessment.score, largest);
    }
    return assessment;
  }

  const MpcOptions& controller_;
  const Badwe2009Options& options_;
};

/// Shared out among all channels, the confidence is that of a loop; otherwise that of a channel or a lag.
std::optional<double> stated_false_alarms(const AssessmentOptions& options) {
  if (options.badwe2009.multiplicity != Multiplicity::channels)
    return std::nullopt;
  return 1.0 - options.badwe2009.confidence;
}

}  // namespace

AssessmentMethodInfo badwe2009_method() {
  return {{.name = "badwe2009",
           .title = "Badwe et al. (2009)",
           .verdict = "some prediction error follows an MV: a strong partial correlation",
           .requirements = {.moving_mvs = true},
           .locates_cvs = true,
           .names_channels = true,
           .tells_sources = false,
           .numbers = {{"partial_correlation", NumberScope::channel,
                        "correlation of eps1 and eps2 (2.5, 2.6) at the lag where it is largest"},
                       {"strength", NumberScope::channel, "its size over its confidence band"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<Badwe2009>(context); },
          stated_false_alarms};
}

}  // namespace mpm
