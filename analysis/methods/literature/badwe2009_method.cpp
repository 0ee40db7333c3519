#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/badwe2009.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

OptionKeys keys(Badwe2009Options& options) {
  return {
      key::choice("filter", options.filter,
                  {"automatic", "none", "moving-average", "first-order", "external"},
                  "filter that removes noise first (A1.2). `\"external\"`: only the part of the MVs that "
                  "setpoints and measured disturbances cause. `\"automatic\"`: `\"external\"` if at least as "
                  "many setpoints and measured disturbances move as MVs are evaluated, since fewer cannot "
                  "tell the MVs apart; otherwise `\"none\"`"),
      key::whole("filter_length", options.filter_length, 1, 1000,
                 "samples of the moving average; time constant of the first-order filter in samples"),
      key::choice("model", options.models.model, {"output-error", "fir"},
                  "models of (2.5) and (2.6). `\"fir\"`: a regression, which has one solution and takes a "
                  "hundredth of the time. `\"output-error\"`: the search of the thesis"),
      key::whole("nb", options.models.nb, 1, 1000, "order of B of each path of an output-error model"),
      key::whole("nf", options.models.nf, 0, 1000, "order of F of each path"),
      key::whole("fir_length", options.models.fir_length, 1, 1000,
                 "number of Laguerre filters for each input, one of them direct"),
      key::number("fir_pole", options.models.fir_pole, NumberRule::below_one(),
                  "pole of the Laguerre filters, about exp(-sample time/time constant) of the slow channels; "
                  "0 is a finite impulse response"),
      key::whole("min_lag", options.min_lag, 0, 1000,
                 "first lag of the correlations. u(k) acts after y(k), so lag 0 has only the response of the "
                 "controller to the noise of y(k)"),
      key::whole_from("max_lag", options.max_lag, options.min_lag, 1000,
                      "last lag, about the dead time plus the time constant of the slow channels. A record "
                      "must have at least four times as many samples")
          .allow("`min_lag` to 1000"),
      key::number("confidence", options.confidence, NumberRule::inside(0, 1),
                  "confidence of the band of the partial correlation"),
      key::choice("multiplicity", options.multiplicity, {"none", "lags", "channels"},
                  "number of correlations among which 1 - `confidence` is divided: one, the lags of a "
                  "channel, or the lags of all channels. With `\"channels\"`, 1 - `confidence` is the rate "
                  "of false alarms of a loop"),
      key::number(
          "weakest_correlation", options.weakest_correlation, NumberRule::share(),
          "largest correlation that is not strong, however significant it is; the thesis gives no number"),
      key::number("saturated_share", options.saturated_share, NumberRule::share(),
                  "an MV that is at a hard limit for more than this share of the record is left out (\"most "
                  "of the time\", 2.4.2)"),
      key::number("smallest_deviation", options.smallest_deviation, NumberRule::at_least(0),
                  "an MV with a smaller standard deviation is left out"),
      key::number("smallest_own_share", options.smallest_own_share, NumberRule::share(),
                  "an MV is left out if (2.5) leaves less than this share of its variance")};
}

class Badwe2009 final : public AssessmentMethod {
 public:
  explicit Badwe2009(const AssessmentContext& context)
      : controller_(context.study.controller), options_(context.study.assessment.of<Badwe2009Options>()) {}

  Assessment assess(const AssessedLoop& loop) override {
    const Badwe2009Record record = record_of(loop);
    const Eigen::Index needed = samples_needed(record);
    if (loop.samples() < needed)
      return Assessment::not_applicable(
          fmt::format("its models and lags need {} samples, and the record has {}", needed, loop.samples()));
    const Badwe2009Result result = assess_badwe2009(record, options_);
    if (result.status == Badwe2009Status::no_mv)
      return Assessment::failed("no MV is left: all are saturated, stand still or follow other MVs");
    return assessment_of(result, loop.y.rows(), loop.u.rows());
  }

 private:
  /// The signals from outside. Setpoints of the optimizer are not among them, because they follow from the
  /// measurements.
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

  /// The samples that `assess_badwe2009` needs: more than it has coefficients, and four for each lag.
  Eigen::Index samples_needed(const Badwe2009Record& record) const {
    const Eigen::Index inputs = std::max(record.u.rows() - 1, record.external.rows());
    const Eigen::Index each = options_.models.model == DecorrelationModel::fir
                                  ? options_.models.fir_length
                                  : options_.models.nb + options_.models.nf;
    return std::max<Eigen::Index>(inputs * each + 2, Eigen::Index{4} * options_.max_lag);
  }

  static Assessment assessment_of(const Badwe2009Result& result, Eigen::Index ny, Eigen::Index nu) {
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < ny; ++cv) {
      bool flagged = false;
      double largest = kNaN;  // stays NaN if no MV is evaluated
      for (Eigen::Index mv = 0; mv < nu; ++mv) {
        const ChannelAssessment& channel = result.channel(cv, mv);
        const double strength = std::abs(channel.correlation.peak) / channel.correlation.band;
        largest = std::fmax(largest, strength);
        flagged = flagged || channel.mismatch;
        if (channel.mismatch)
          assessment.flagged_channels.push_back({cv, mv});
        assessment.numbers.push_back({"partial_correlation", channel.correlation.peak, cv, mv});
        assessment.numbers.push_back({"strength", strength, cv, mv});
      }
      assessment.cvs.push_back({flagged, largest, FaultSource::none});
      assessment.flagged = assessment.flagged || flagged;
      assessment.score = std::fmax(assessment.score, largest);
    }
    return assessment;
  }

  const MpcOptions& controller_;
  const Badwe2009Options& options_;
};

/// A confidence that is divided among all channels is that of a loop; otherwise it is that of a channel or a
/// lag.
std::optional<double> stated_false_alarms(const MethodOptions& of_methods) {
  const auto& options = of_methods.of<Badwe2009Options>();
  if (options.multiplicity != Multiplicity::channels)
    return std::nullopt;
  return 1.0 - options.confidence;
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
                       {"strength", NumberScope::channel,
                        "size of the partial correlation over its confidence band"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<Badwe2009>(context); },
          option_table<Badwe2009Options>(keys, "options of the method of Badwe et al. (2009)"),
          stated_false_alarms};
}

}  // namespace mpm
