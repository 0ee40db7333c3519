#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/identification/autoregression.hpp"
#include "analysis/identification/decorrelation.hpp"
#include "analysis/identification/noise_filter.hpp"
#include "analysis/identification/prewhitened_test.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/mismatch_profile.hpp"
#include "analysis/methods/literature/plant_model_ratio.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/methods/shared/error_regression.hpp"
#include "analysis/methods/shared/outside_signals.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

enum class RatioInstruments : std::int8_t { outside, setpoints };

struct PmrOptions {
  double alpha = 0.01;  ///< largest share of loops without mismatch that are flagged
  RatioInstruments instruments = RatioInstruments::outside;
  /// Options of the regression of the MVs on the signals from outside.
  DecorrelationOptions drive{.fir_length = 10, .fir_pole = 0.9};

  bool operator==(const PmrOptions&) const = default;
};

OptionKeys keys(PmrOptions& options) {
  return {
      key::number("alpha", options.alpha, NumberRule::inside(0, 1),
                  "largest share of loops without mismatch that are flagged, divided among the CVs"),
      key::choice("instruments", options.instruments, {"outside", "setpoints"},
                  "signals that are independent of the disturbances and explain the MVs. `\"outside\"`: MDs, "
                  "setpoints, moving limits and test signals. `\"setpoints\"`: the setpoints alone, as in "
                  "the papers. The default is `\"outside\"` because a controller in ranges has no setpoints"),
      key::whole("filters", options.drive.fir_length, 1, 100,
                 "number of Laguerre filters of each of these signals, one of them direct, in the regression "
                 "of the MVs. More filters follow the MVs better, but also follow some of their noise"),
      key::number("pole", options.drive.fir_pole, NumberRule::below_one(), "pole of these filters")};
}

/// The plant-model ratio (Selvanathan and Tangirala 2010; Kaw, Tangirala and Karimi 2014; Mittermaier, le
/// Roux and Craig 2024), a reconstruction from the abstracts. It estimates G(jw)/G0(jw) of each channel in
/// closed loop, from the moves that signals from outside of the loop cause.
///
///   u_o = V r                          what they make of the MVs (externally_driven), in two stages
///   e   = (P - 1) G0 u_o + n,          n = (G - G0)(u - u_o) + v does not depend on r
///   P   = 1 + sum_k b_k L_k / G0       plant_model_ratio()
///
/// with e = y - y_sim of a CV, r the signals from outside and L_k the filters of the channel. P is smooth,
/// with three coefficients: a few steps in r cannot determine a free value at each frequency. A CV is flagged
/// if prewhitened_test() rejects b = 0 for all its channels together, that is, a ratio of 1, with alpha
/// divided among the CVs. No part of u_o follows the noise, so the past of e need not be projected out as in
/// PrewhitenedGroups. The signatures of gain, time constant and dead time are each fitted over all
/// frequencies, weighted by excitation and noise; profiled_mismatches() of u_o does this in the time domain.
/// The signature that explains most, among all channels of the MVs, names channel, parameter and size.
class PlantModelRatio final : public AssessmentMethod {
 public:
  explicit PlantModelRatio(const AssessmentContext& context)
      : study_(context.study), options_(context.study.assessment.of<PmrOptions>()), outside_(context.study) {}

  Assessment assess(const AssessedLoop& loop) override {
    const AssessedLoop& whole = loop.from_start();
    const Eigen::MatrixXd r = options_.instruments == RatioInstruments::setpoints
                                  ? outside_.setpoints_of(whole)
                                  : outside_.of(whole);
    if (moving_rows(loop.in_window(r)).rows() == 0)
      return Assessment::not_applicable(options_.instruments == RatioInstruments::setpoints
                                            ? "no setpoint of the controller moves"
                                            : "no signal from outside moves the loop");
    const Eigen::Index fewest = std::max(fewest_prewhitened_samples(kChannelFilters * study_.plant.G.cols()),
                                         2 * (1 + options_.drive.fir_length * r.rows()));
    if (loop.samples() < fewest)
      return Assessment::not_applicable(fmt::format("its regressions need {} samples or more", fewest));
    const Eigen::MatrixXd inputs = driven_inputs(loop, r);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      judge_cv(cv, (loop.y.row(cv) - loop.y_sim.row(cv)).transpose(), inputs, assessment);
    return assessment;
  }

 private:
  /// u_o, followed by the MDs, which come from outside; otherwise as inputs_until().
  Eigen::MatrixXd driven_inputs(const AssessedLoop& loop, const Eigen::MatrixXd& r) const {
    const AssessedLoop& whole = loop.from_start();
    Eigen::MatrixXd inputs = inputs_until(loop);
    inputs.topRows(whole.u.rows()) = externally_driven(whole.u, r, options_.drive).leftCols(inputs.cols());
    return inputs;
  }

  void judge_cv(Eigen::Index cv, const Eigen::VectorXd& e, const Eigen::MatrixXd& inputs,
                Assessment& assessment) const {
    require_signal("simulation error", e, 1);
    std::vector<Eigen::MatrixXd> filters;
    for (Eigen::Index j = 0; j < inputs.rows(); ++j)
      filters.emplace_back(channel_filters(study_.assessed_channel(cv, j), study_.controller.sample_time,
                                           inputs.row(j).transpose())
                               .bottomRows(e.size()));
    const Autoregression whiteness = fit_autoregression(e, autoregression_order(e, kHighestNoiseOrder));
    const FTest test = prewhitened_test(e, filters, whiteness).all;
    const double score = significance_score(test.log_p, static_cast<double>(study_.cv_count()));
    const bool flagged = score > -std::log10(options_.alpha);
    assessment.cvs.push_back({flagged, score, flagged ? FaultSource::mpm : FaultSource::none});
    assessment.numbers.push_back({"log10_p", test.log_p / std::numbers::ln10, cv});
    const bool worst = std::isnan(assessment.score) || score > assessment.score;
    assessment.flagged = assessment.flagged || flagged;
    assessment.score = worst ? score : assessment.score;
    if (!flagged)
      return;
    const std::optional<NamedMismatch> named = best_signature(cv, e, filters, inputs);
    if (worst)
      assessment.named_mismatch = named;
    if (named)
      add_channel(*named, e, filters[static_cast<std::size_t>(named->channel.mv)], assessment);
  }

  /// The signature that explains most, among all channels of the CV with an MV; none if no MV moves.
  std::optional<NamedMismatch> best_signature(Eigen::Index cv, const Eigen::VectorXd& e,
                                              const std::vector<Eigen::MatrixXd>& filters,
                                              const Eigen::MatrixXd& inputs) const {
    const Eigen::Index order = refined_groups(e, filters).noise.order();
    std::optional<NamedMismatch> named;
    double least = 0.0;
    for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
      const TransferFunction& channel = study_.assessed_channel(cv, mv);
      if (channel.is_zero() || stands_still(inputs.row(mv).transpose()))
        continue;
      const ProfiledMismatch best =
          profiled_mismatches(e, inputs.row(mv).transpose(), channel, study_.controller.sample_time, order,
                              study_.aggregate.confidence)
              .front();
      if (!named || best.residual_sum < least) {
        least = best.residual_sum;
        named = {{cv, mv}, best.parameter, best.value, best.lower, best.upper, best.bound};
      }
    }
    return named;
  }

  /// Adds the named channel and the signature of its ratio, as if no other channel of the CV were wrong.
  void add_channel(const NamedMismatch& named, const Eigen::VectorXd& e, const Eigen::MatrixXd& filters,
                   Assessment& assessment) const {
    const auto [cv, mv] = named.channel;
    const TransferFunction& channel = study_.assessed_channel(cv, mv);
    assessment.flagged_channels.push_back(named.channel);
    if (channel.is_integrating())
      return;
    const RatioSignature read =
        ratio_signature(channel, study_.controller.sample_time, refined_groups(e, {filters}).coefficients());
    assessment.numbers.push_back({"magnitude", read.magnitude, cv, mv});
    assessment.numbers.push_back({"bend", read.bend, cv, mv});
    assessment.numbers.push_back({"delay", read.delay, cv, mv});
  }

  const Study& study_;
  const PmrOptions& options_;
  OutsideSignals outside_;
};

}  // namespace

AssessmentMethodInfo pmr_method() {
  return {
      {.name = "pmr",
       .title = "after Selvanathan and Tangirala (2010), reconstructed",
       .verdict =
           "the plant-model ratio of some CV, estimated from signals from outside of the loop, is not 1",
       .requirements = {.moving_mvs = true},
       .locates_cvs = true,
       .names_channels = true,
       .tells_sources = true,
       .names_mismatches = true,
       .numbers = {{"log10_p", NumberScope::cv,
                    "log10 p of the hypothesis that all plant-model ratios are 1"},
                   {"magnitude", NumberScope::channel, "|P| of a named channel at a tenth of its corner"},
                   {"bend", NumberScope::channel, "|P| at its corner over that"},
                   {"delay", NumberScope::channel, "-arg P / w at its corner", "time unit of the plant"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<PlantModelRatio>(context); },
      option_table<PmrOptions>(keys, "options of the plant-model ratio"),
      [](const MethodOptions& options) { return options.of<PmrOptions>().alpha; }};
}

}  // namespace mpm
