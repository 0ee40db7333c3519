#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/student.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The probability that a loop without mismatch is flagged, divided among its CVs.
constexpr double kLocalFalseAlarms = 0.01;

/// The parameter of each column of channel_gradients().
constexpr std::array kGradientParameters{MismatchParameter::gain, MismatchParameter::time_constant,
                                         MismatchParameter::dead_time};
/// The value of each parameter in the model: factors of 1, no shift.
constexpr std::array kGradientNominal{1.0, 1.0, 0.0};

/// One parameter of a channel in the local approach: z = psi'r / (|psi| sigma), and the single step to its
/// estimate with the standard deviation.
struct LocalParameter {
  double z = 0.0;
  double step = 0.0, deviation = kInfinity;
};

LocalParameter local_parameter(const PrewhitenedGroups& groups, std::size_t channel, Eigen::Index column) {
  const auto psi = groups.X[channel].col(column);
  const double length = psi.norm();
  const double sigma = std::sqrt(groups.variance);
  if (length == 0.0 || sigma == 0.0)
    return {};
  const double product = psi.dot(groups.r);
  return {product / (length * sigma), product / (length * length), sigma / length};
}

/// The local approach to the divergence of two models (Jiang, Huang and Shah 2009; Basseville 1998). It uses
/// the gradient of the prediction error with respect to the parameters of the model, at the model. The mean
/// of this gradient is zero as long as the model holds, and points in the direction of the change if it does
/// not. A reconstruction.
///
/// Here psi_jk = A dG_ij/dtheta_jk u_j is prewhitened by the autoregression A of the simulation error, and
/// the past of the error is projected out (PrewhitenedGroups). r is the error after the same steps,
///
///   zeta = Psi'r / sqrt(n),   chi2 = zeta' (sigma^2 Psi'Psi / n)^-1 zeta,   F = chi2 / rank Psi
///   z_jk = psi_jk'r / (sigma |psi_jk|),   theta_jk = theta0_jk + psi_jk'r / |psi_jk|^2
///
/// F flags a CV. The part of F from the three parameters of one channel names the channel, and the largest
/// |z_jk| names the parameter. Because the past of the error has been projected out, sigma^2 Psi'Psi is the
/// covariance of zeta also in closed loop. The size is one Gauss-Newton step from the model: it is right for
/// small mismatches, and its interval is too small for large ones.
class Local final : public AssessmentMethod {
 public:
  explicit Local(const AssessmentContext& context) : study_(context.study) {}

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::MatrixXd inputs = inputs_until(loop);
    if (const Eigen::Index fewest = fewest_prewhitened_samples(kChannelGradients * inputs.rows());
        loop.samples() < fewest)
      return Assessment::not_applicable(fmt::format("its regressions need {} samples or more", fewest));
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      judge_cv(cv, (loop.y.row(cv) - loop.y_sim.row(cv)).transpose(), inputs, assessment);
    return assessment;
  }

 private:
  void judge_cv(Eigen::Index cv, const Eigen::VectorXd& e, const Eigen::MatrixXd& inputs,
                Assessment& assessment) const {
    std::vector<Eigen::MatrixXd> gradients;
    for (Eigen::Index j = 0; j < inputs.rows(); ++j)
      gradients.emplace_back(channel_gradients(study_.assessed_channel(cv, j), study_.controller.sample_time,
                                               inputs.row(j).transpose())
                                 .bottomRows(e.size()));
    const PrewhitenedGroups groups = prewhitened_groups(e, gradients);
    const double probability = kLocalFalseAlarms / static_cast<double>(study_.cv_count());
    const double score = groups.joint_ratio() / groups.critical_ratio_of(groups.rank, probability);
    const bool flagged = score > 1.0;
    assessment.cvs.push_back({flagged, score, flagged ? FaultSource::mpm : FaultSource::none});
    assessment.numbers.push_back({"f", groups.joint_ratio(), cv});
    for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv)
      for (Eigen::Index k = 0; k < gradients[static_cast<std::size_t>(mv)].cols(); ++k)
        assessment.numbers.push_back({kNames[static_cast<std::size_t>(k)],
                                      local_parameter(groups, static_cast<std::size_t>(mv), k).z, cv, mv});
    const bool worst = !(score <= assessment.score);
    assessment.flagged = assessment.flagged || flagged;
    assessment.score = std::fmax(assessment.score, score);
    if (flagged)
      name_channels(cv, groups, worst, assessment);
  }

  /// Names the channel that explains most alone, and channels that explain something beside all others.
  void name_channels(Eigen::Index cv, const PrewhitenedGroups& groups, bool worst,
                     Assessment& assessment) const {
    std::size_t surest = 0;
    for (std::size_t j = 1; j < groups.Q.size(); ++j)
      if (explained(groups, j) > explained(groups, surest))
        surest = j;
    const double probability =
        kLocalFalseAlarms /
        static_cast<double>(groups.Q.size() * static_cast<std::size_t>(study_.cv_count()));
    for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
      const auto j = static_cast<std::size_t>(mv);
      if (j == surest || groups.partial_ratio(j) > groups.critical_ratio(j, probability))
        assessment.flagged_channels.push_back({cv, mv});
    }
    if (worst) {
      assessment.named_mismatch.reset();
      if (static_cast<Eigen::Index>(surest) < study_.mv_count())
        assessment.named_mismatch = named(cv, surest, groups);
    }
  }

  static double explained(const PrewhitenedGroups& groups, std::size_t j) {
    return groups.ratio(j) * static_cast<double>(groups.Q[j].cols());
  }

  NamedMismatch named(Eigen::Index cv, std::size_t channel, const PrewhitenedGroups& groups) const {
    std::size_t best = 0;
    LocalParameter surest;
    for (std::size_t k = 0; k < kGradientParameters.size(); ++k) {
      const LocalParameter each = local_parameter(groups, channel, static_cast<Eigen::Index>(k));
      if (std::abs(each.z) > std::abs(surest.z)) {
        best = k;
        surest = each;
      }
    }
    const double half = surest.deviation * student_quantile(0.5 * (1.0 + study_.aggregate.confidence),
                                                            static_cast<double>(groups.freedom));
    const double size = kGradientNominal[best] + surest.step;
    return {
        {cv, static_cast<Eigen::Index>(channel)}, kGradientParameters[best], size, size - half, size + half};
  }

  static constexpr std::array<const char*, 3> kNames{"z_gain", "z_time_constant", "z_dead_time"};

  const Study& study_;
};

}  // namespace

AssessmentMethodInfo local_method() {
  return {
      {.name = "local",
       .title = "after Jiang et al. (2009), reconstructed",
       .verdict = "the gradient of the prediction error with respect to the parameters of the model has a "
                  "nonzero mean",
       .requirements = {.moving_mvs = true},
       .locates_cvs = true,
       .names_channels = true,
       .tells_sources = true,
       .names_mismatches = true,
       .information = ModelInformation::shown,
       .stated_false_alarms = kLocalFalseAlarms,
       .numbers = {{"f", NumberScope::cv, "chi2 of the normalised gradient over its degrees of freedom"},
                   {"z_gain", NumberScope::channel,
                    "gradient with respect to the factor of the gain, over its standard deviation"},
                   {"z_time_constant", NumberScope::channel,
                    "gradient with respect to the factor of the time constant, over its standard deviation"},
                   {"z_dead_time", NumberScope::channel,
                    "gradient with respect to the shift of the dead time, over its standard deviation"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Local>(context); }};
}

}  // namespace mpm
