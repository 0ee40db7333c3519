#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "analysis/identification/group_lasso.hpp"
#include "analysis/identification/lasso_penalty.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/channel_regressors.hpp"
#include "analysis/methods/literature/mismatch_profile.hpp"
#include "analysis/methods/literature/prewhitened_groups.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "base/non_finite.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

/// The probability that a loop without mismatch is flagged, divided among all channels.
constexpr double kLassoFalseAlarms = 0.01;

/// The rule for the size of lambda.
enum class LassoPenalty : std::int8_t {
  chance,  ///< a group that explains nothing enters with the probability kLassoFalseAlarms, divided among all
  cross_validation,  ///< cross_validated_penalty(), the rule of Kono and Koizumi
};

struct LassoOptions {
  LassoPenalty penalty = LassoPenalty::chance;

  bool operator==(const LassoOptions&) const = default;
};

OptionKeys keys(LassoOptions& options) {
  return {key::choice("penalty", options.penalty, {"chance", "cross-validation"},
                      "rule for lambda. `\"chance\"`: 1 % is divided among all channels as the probability "
                      "that a channel which explains nothing enters; the channels that stay significant "
                      "beside the others are named. `\"cross-validation\"`, as in the paper: over five "
                      "stretches of the record; all channels that enter are named")};
}

using Groups = std::vector<Eigen::MatrixXd>;

/// The result of the lasso for one CV.
struct LassoCv {
  double score = 0.0;
  std::vector<std::size_t> selected;  ///< columns of G that the lasso selects
  std::vector<std::size_t> named;     ///< selected columns that have a mismatch
  std::vector<double> ratios;         ///< for each channel, over its critical value
  PrewhitenedGroups refined;          ///< regression on the named channels, in their order
};

/// |Q_j'r|^2 of each group, over the value that chance exceeds with this probability.
std::vector<double> entry_ratios(const PrewhitenedGroups& groups, double probability) {
  std::vector<double> ratios;
  for (std::size_t j = 0; j < groups.Q.size(); ++j)
    ratios.push_back(groups.ratio(j) / groups.critical_ratio(j, probability));
  return ratios;
}

/// The groups that the lasso selects if each group that explains nothing enters with this probability.
std::vector<std::size_t> selected_groups(const PrewhitenedGroups& groups, double probability) {
  std::vector<Eigen::Index> sizes;
  Eigen::VectorXd penalty(static_cast<Eigen::Index>(groups.Q.size()));
  Eigen::Index columns = 0;
  for (std::size_t j = 0; j < groups.Q.size(); ++j) {
    sizes.push_back(groups.Q[j].cols());
    columns += sizes[j];
    penalty(static_cast<Eigen::Index>(j)) = sizes[j] == 0
                                                ? 0.0
                                                : std::sqrt(groups.critical_ratio(j, probability) *
                                                            static_cast<double>(sizes[j]) * groups.variance);
  }
  Eigen::MatrixXd Q(groups.r.size(), columns);
  columns = 0;
  for (const Eigen::MatrixXd& each : groups.Q) {
    Q.middleCols(columns, each.cols()) = each;
    columns += each.cols();
  }
  const Eigen::VectorXd b = group_lasso(Q.transpose() * Q, Q.transpose() * groups.r, sizes, penalty);
  std::vector<std::size_t> selected;
  columns = 0;
  for (std::size_t j = 0; j < sizes.size(); ++j) {
    if (!b.segment(columns, sizes[j]).isZero(0.0))
      selected.push_back(j);
    columns += sizes[j];
  }
  return selected;
}

/// The groups that enter under the penalty with the best predictions.
std::vector<std::size_t> groups_by_cross_validation(const PrewhitenedGroups& groups) {
  const double lambda = cross_validated_penalty(groups.r, groups.Q);
  const std::vector<Eigen::VectorXd> b = penalised_coefficients(groups.r, groups.Q, lambda);
  std::vector<std::size_t> selected;
  for (std::size_t j = 0; j < b.size(); ++j)
    if (!b[j].isZero(0.0))
      selected.push_back(j);
  return selected;
}

Groups groups_of(const Groups& all, const std::vector<std::size_t>& places) {
  Groups some;
  for (const std::size_t place : places)
    some.push_back(all[place]);
  return some;
}

/// The lasso shrinks the channels that it selects. The part of a channel that this leaves unexplained brings
/// in other channels with similar moves. So only those selected channels are named that explain, beside the
/// others, more than chance does, with the noise model of the errors that they leave. The weakest channel is
/// dropped first. With cross-validation all selected channels are named.
LassoCv lasso_of(const Eigen::VectorXd& e, const Groups& filters, double probability, LassoPenalty penalty) {
  LassoCv result;
  const PrewhitenedGroups groups = prewhitened_groups(e, filters);
  result.ratios = entry_ratios(groups, probability);
  if (groups.variance > 0.0)
    result.selected = penalty == LassoPenalty::chance ? selected_groups(groups, probability)
                                                      : groups_by_cross_validation(groups);
  result.named = result.selected;
  while (!result.named.empty()) {
    result.refined = refined_groups(e, groups_of(filters, result.named));
    std::vector<double> partial;
    for (std::size_t i = 0; i < result.named.size(); ++i)
      partial.push_back(result.refined.partial_ratio(i) / result.refined.critical_ratio(i, probability));
    const auto weakest = std::min_element(partial.begin(), partial.end());
    if (*weakest > 1.0 || penalty == LassoPenalty::cross_validation) {
      for (std::size_t i = 0; i < partial.size(); ++i)
        result.ratios[result.named[i]] = partial[i];
      result.score = *std::max_element(partial.begin(), partial.end());
      return result;
    }
    result.named.erase(result.named.begin() + (weakest - partial.begin()));
  }
  for (double& ratio : result.ratios) {
    ratio = std::min(ratio, 1.0);
    result.score = larger_or_nan(result.score, ratio);
  }
  return result;
}

/// L1 regression of the simulation errors on the inputs (Kono and Koizumi 2023): finds the channels of the
/// model that the record contradicts, and the size of their correction. A reconstruction from the abstract;
/// the groups, the prewhitening and the penalty are our own.
///
///   min over b of  1/2 |r - sum_j Q_j b_j|^2 + sum_j lambda_j |b_j|
///   lambda_j^2 = m_j sigma^2 F_(1 - alpha/channels)(m_j, freedom)
///
/// for each CV, where r is the simulation error and Q_j are the responses of three filters of channel j, both
/// prewhitened (PrewhitenedGroups). With this penalty, a group that explains nothing enters with the
/// probability alpha = 1 %, divided among all channels of the loop. So the penalty needs neither
/// cross-validation nor a benchmark; LassoPenalty has the penalty of the paper as well.
class Lasso final : public AssessmentMethod {
 public:
  explicit Lasso(const AssessmentContext& context)
      : study_(context.study), penalty_(context.study.assessment.of<LassoOptions>().penalty) {}

  Assessment assess(const AssessedLoop& loop) override {
    const Eigen::MatrixXd inputs = inputs_until(loop);
    if (const Eigen::Index fewest = fewest_prewhitened_samples(kChannelFilters * inputs.rows());
        loop.samples() < fewest)
      return Assessment::not_applicable(fmt::format("its regressions need {} samples or more", fewest));
    const double probability = kLassoFalseAlarms / static_cast<double>(inputs.rows() * loop.y.rows());
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
      const Eigen::VectorXd e = (loop.y.row(cv) - loop.y_sim.row(cv)).transpose();
      const Groups filters = filters_of(cv, inputs, loop.samples());
      LassoCv found = lasso_of(e, filters, probability, penalty_);
      const std::optional<NamedMismatch> surest = surest_mismatch(cv, found, e, filters, inputs);
      if (!found.named.empty() && !(found.score <= assessment.score))
        assessment.named_mismatch = surest;
      assessment.cvs.push_back(
          {!found.named.empty(), found.score, found.named.empty() ? FaultSource::none : FaultSource::mpm});
      assessment.flagged = assessment.flagged || !found.named.empty();
      assessment.score = std::fmax(assessment.score, found.score);
      add_channels(cv, found, assessment);
    }
    return assessment;
  }

 private:
  Groups filters_of(Eigen::Index cv, const Eigen::MatrixXd& inputs, Eigen::Index samples) const {
    Groups filters;
    for (Eigen::Index j = 0; j < inputs.rows(); ++j)
      filters.push_back(channel_filters(study_.assessed_channel(cv, j), study_.controller.sample_time,
                                        inputs.row(j).transpose())
                            .bottomRows(samples));
    return filters;
  }

  void add_channels(Eigen::Index cv, const LassoCv& found, Assessment& assessment) const {
    for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv)
      assessment.numbers.push_back({"ratio", found.ratios[static_cast<std::size_t>(mv)], cv, mv});
    if (found.named.empty())
      return;
    const Eigen::VectorXd b = found.refined.coefficients();
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < found.named.size(); ++i) {
      const auto input = static_cast<Eigen::Index>(found.named[i]);
      const Eigen::Index columns = found.refined.X[i].cols();
      const double difference = b.segment(first, columns).sum();
      first += columns;
      if (input >= study_.mv_count())
        continue;
      const TransferFunction& channel = study_.assessed_channel(cv, input);
      assessment.flagged_channels.push_back({cv, input});
      if (channel.static_gain() != 0.0)
        assessment.numbers.push_back(
            {"gain_factor",
             1.0 + difference * channel_filter_gain(channel, study_.controller.sample_time) /
                       channel.static_gain(),
             cv, input});
    }
  }

  ProfiledMismatch profiled(Eigen::Index cv, Eigen::Index input, const LassoCv& found,
                            const Eigen::VectorXd& e, const Eigen::MatrixXd& inputs) const {
    return profiled_mismatches(e, inputs.row(input).transpose(), study_.assessed_channel(cv, input),
                               study_.controller.sample_time, found.refined.noise.order(),
                               study_.aggregate.confidence)
        .front();
  }

  /// The mismatch of one number that explains the simulation error best, among all channels that the lasso
  /// selected. Three filters do not follow a mismatch exactly. If the noise is small, other channels
  /// compensate for the rest, so the selection alone does not tell which channel is wrong. If one number
  /// explains the error as well as the filters of all named channels do, by BIC, `found` then names only its
  /// channel. If it does not, the mismatch is that of the channel that explains most, after the part that the
  /// others explain is removed from the error. None if no channel is named, or if that channel has a measured
  /// disturbance as its input.
  std::optional<NamedMismatch> surest_mismatch(Eigen::Index cv, LassoCv& found, const Eigen::VectorXd& e,
                                               const Groups& filters, const Eigen::MatrixXd& inputs) const {
    if (found.named.empty())
      return std::nullopt;
    std::optional<ProfiledMismatch> best;
    std::size_t surest = 0;
    for (const std::size_t j : found.selected) {
      const auto input = static_cast<Eigen::Index>(j);
      if (input >= study_.mv_count())
        continue;
      const ProfiledMismatch each = profiled(cv, input, found, e, inputs);
      if (!best || each.residual_sum < best->residual_sum) {
        best = each;
        surest = j;
      }
    }
    if (best && explains_as_much(*best, found, e.size())) {
      if (found.named != std::vector<std::size_t>{surest}) {
        found.named = {surest};
        found.refined = refined_groups(e, {filters[surest]});
      }
    } else {
      const auto more = [&found](std::size_t a, std::size_t b) { return found.ratios[a] < found.ratios[b]; };
      surest = *std::max_element(found.named.begin(), found.named.end(), more);
      if (static_cast<Eigen::Index>(surest) >= study_.mv_count())
        return std::nullopt;
      best = profiled(cv, static_cast<Eigen::Index>(surest), found,
                      e - explained_by_others(found, surest, filters), inputs);
    }
    return NamedMismatch{{cv, static_cast<Eigen::Index>(surest)},
                         best->parameter,
                         best->value,
                         best->lower,
                         best->upper,
                         best->bound};
  }

  static bool explains_as_much(const ProfiledMismatch& one, const LassoCv& found, Eigen::Index samples) {
    const auto n = static_cast<double>(found.refined.r.size());
    const double of_one = one.residual_sum / static_cast<double>(samples - found.refined.noise.order());
    const double of_all = found.refined.variance * static_cast<double>(found.refined.freedom) / n;
    return n * std::log(of_one / of_all) < static_cast<double>(found.refined.rank - 1) * std::log(n);
  }

  static Eigen::VectorXd explained_by_others(const LassoCv& found, std::size_t channel,
                                             const Groups& filters) {
    const Eigen::VectorXd b = found.refined.coefficients();
    Eigen::VectorXd explained = Eigen::VectorXd::Zero(filters[channel].rows());
    Eigen::Index first = 0;
    for (const std::size_t j : found.named) {
      if (j != channel)
        explained += filters[j] * b.segment(first, filters[j].cols());
      first += filters[j].cols();
    }
    return explained;
  }

  const Study& study_;
  LassoPenalty penalty_;
};

}  // namespace

AssessmentMethodInfo lasso_method() {
  return {
      {.name = "lasso",
       .title = "after Kono and Koizumi (2023), reconstructed",
       .verdict = "channels of the model are wrong: the group lasso of the simulation errors on the inputs "
                  "selects them",
       .requirements = {.moving_mvs = true},
       .locates_cvs = true,
       .names_channels = true,
       .tells_sources = true,
       .names_mismatches = true,
       .information = ModelInformation::shown,
       .stated_false_alarms = kLassoFalseAlarms,
       .numbers = {{"ratio", NumberScope::channel,
                    "squares that the channel explains, over the threshold at which chance selects it"},
                   {"gain_factor", NumberScope::channel,
                    "static gain of a selected channel over that of the model"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Lasso>(context); },
      option_table<LassoOptions>(keys, "options of the method `lasso`")};
}

}  // namespace mpm
