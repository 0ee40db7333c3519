#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/noise_model.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/signal_check.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct MqiChannelsOptions {
  double tolerance = 0.85;  ///< a submodel with 1/rho below it is worse than no submodel

  bool operator==(const MqiChannelsOptions&) const = default;
};

OptionKeys keys(MqiChannelsOptions& options) {
  return {key::number("tolerance", options.tolerance, NumberRule::positive(),
                      "a channel is named when 1/rho lies below it. The default is the tolerance of the "
                      "index of Sun et al. (2.4.2)")};
}

/// Model quality with one submodel left out (Li, Song, Zhang, Ye and Yang 2017), a reconstruction from the
/// abstract. The submodel of channel (i, j) is moved to the disturbance channel: its output is then predicted
/// by the model of the disturbance instead of by the model. Then the model quality index of the CV is
/// computed again. Innovations of the autoregression of least BIC stand for the errors of one-step
/// predictions with the best disturbance model,
///
///   e^p_i = innovations of y_i - sum_l G0_il u_l,    e^p_ij = innovations of y_i - sum_(l != j) G0_il u_l
///   rho_ij = MQI_i without submodel j / MQI_i = sum (e^p_i)^2 / sum (e^p_ij)^2
///
/// because both indices contain the disturbance innovations e^d of (2.4). A correct submodel predicts what no
/// disturbance model can, so rho is below 1. If rho is above 1, the model is better without the submodel. A
/// channel is named if 1/rho lies below the tolerance.
class MqiChannels final : public AssessmentMethod {
 public:
  explicit MqiChannels(const AssessmentContext& context)
      : study_(context.study), tolerance_(context.study.assessment.of<MqiChannelsOptions>().tolerance) {}

  Assessment assess(const AssessedLoop& loop) override {
    if (const Eigen::Index fewest = fewest_prewhitened_samples(0); loop.samples() < fewest)
      return Assessment::not_applicable(fmt::format("its autoregressions need {} samples or more", fewest));
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      judge_cv(cv, loop, assessment);
    if (const std::optional<Eigen::Index> worst = assessment.worst_cv())
      assessment.score = assessment.cvs[static_cast<std::size_t>(*worst)].score;
    else
      assessment = Assessment::failed("no submodel moves its CV");
    return assessment;
  }

 private:
  void judge_cv(Eigen::Index cv, const AssessedLoop& loop, Assessment& assessment) const {
    const Eigen::VectorXd e = (loop.y.row(cv) - loop.y_sim.row(cv)).transpose();
    const double whole = innovation_variance(e, kHighestNoiseOrder);
    const Eigen::MatrixXd inputs = inputs_until(loop);
    CvAssessment said;
    for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
      const TransferFunction& channel = study_.assessed_channel(cv, mv);
      if (channel.is_zero() || stands_still(loop.u.row(mv).transpose()))
        continue;
      const Eigen::VectorXd moved =
          channel_response(channel, study_.controller.sample_time, inputs.row(mv).transpose()).tail(e.size());
      const double rho = whole / innovation_variance(e + moved, kHighestNoiseOrder);
      if (!std::isfinite(rho))
        continue;
      assessment.numbers.push_back({"rho", rho, cv, mv});
      if (rho * tolerance_ > 1.0)
        assessment.flagged_channels.push_back({cv, mv});
      said.score = std::isnan(said.score) ? rho : std::max(said.score, rho);
    }
    if (!std::isnan(said.score)) {
      said.flagged = said.score * tolerance_ > 1.0;
      said.source = *said.flagged ? FaultSource::mpm : FaultSource::none;
      assessment.flagged = assessment.flagged || *said.flagged;
    }
    assessment.cvs.push_back(said);
  }

  const Study& study_;
  double tolerance_;
};

}  // namespace

AssessmentMethodInfo mqi_channels_method() {
  return {{.name = "mqi-channels",
           .title = "after Li et al. (2017), reconstructed",
           .verdict = "some submodel is worse than none: the model quality index rises above the tolerance "
                      "when it is left out",
           .requirements = {.moving_mvs = true},
           .locates_cvs = true,
           .names_channels = true,
           .tells_sources = true,
           .numbers = {{"rho", NumberScope::channel,
                        "model quality index of the CV without this submodel over that with it"}}},
          {},
          [](const AssessmentContext& context) { return std::make_unique<MqiChannels>(context); },
          option_table<MqiChannelsOptions>(keys, "options of the model quality without a submodel")};
}

}  // namespace mpm
