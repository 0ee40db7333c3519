#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/loop_autocovariance.hpp"
#include "analysis/methods/literature/mismatch_search.hpp"
#include "analysis/statistics/best_candidate.hpp"
#include "analysis/statistics/chi_squared.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

enum class UnexplainedLoop : std::int8_t { disturbance, mismatch };

struct AutocovarianceOptions {
  double alpha = 0.01;   ///< level of the tests, divided among all CVs
  int largest_lag = 32;  ///< samples; the lags are 0, 1, 2, 4, ... up to this
  UnexplainedLoop unexplained = UnexplainedLoop::disturbance;

  bool operator==(const AutocovarianceOptions&) const = default;
};

OptionKeys keys(AutocovarianceOptions& options) {
  return {key::number("alpha", options.alpha, NumberRule::inside(0, 1), "level of the tests, over all CVs"),
          key::whole("largest_lag", options.largest_lag, 0, 1000,
                     "largest lag in samples; the lags are 0, 1, 2, 4, ... up to it. Neighbouring lags carry "
                     "nearly the same information, so their covariance is nearly singular"),
          key::choice("unexplained", options.unexplained, {"disturbance", "mismatch"},
                      "source of a flagged loop that no mismatch of a single parameter explains. "
                      "`\"mismatch\"` is the choice of the paper, in which nothing else can be wrong")};
}

/// The number of families that are refined a second time, and the range of this, in steps of the grid.
constexpr std::size_t kRefined = 3;
constexpr double kSecondStep = 0.25;
/// Points for each step of the grid of a family, because the distance of autocovariances has more than one
/// minimum.
constexpr Eigen::Index kFiner = 4;
/// An MV counts as at a hard limit if it is this near to it, as a share of its range.
constexpr double kAtLimit = 1e-6;
constexpr double kIntervalStep = 0.01;  ///< first step to the end of an interval, share of the search

double chi_squared_limit(Eigen::Index freedom, double probability) {
  return chi_squared_upper_quantile(probability, static_cast<double>(freedom));
}

/// The squared distance r' Sigma^-1 r.
class SquaredDistance {
 public:
  explicit SquaredDistance(const Eigen::MatrixXd& covariance) : root_(covariance) {}

  bool is_usable() const { return root_.info() == Eigen::Success; }
  double operator()(const Eigen::VectorXd& r) const {
    return r.allFinite() ? root_.matrixL().solve(r).squaredNorm() : kInfinity;
  }

 private:
  Eigen::LLT<Eigen::MatrixXd> root_;
};

/// The mismatches of one parameter of a channel, with their autocovariances at the points of the grid.
struct GriddedFamily {
  Channel channel;
  MismatchFamily family;
  Eigen::MatrixXd means;  ///< one column for each point
};

/// A mismatch that may explain the autocovariances.
struct FittedFamily {
  const GriddedFamily* of = nullptr;
  double x = 0.0, distance = kInfinity;
};

/// Plant-model mismatch from autocovariances (Wang, Simkoff, Baldea et al. 2018), a reconstruction from the
/// abstract. The mismatch of an unconstrained linear MPC loop is the one whose theoretical autocovariances of
/// the CVs match those of the record,
///
///   theta = argmin (c - c(theta))' Sigma(theta)^-1 (c - c(theta))
///
/// with c = loop_autocovariance() and c(theta), Sigma(theta) from theoretical_autocovariance() and
/// autocovariance_covariance(), at the lags 0, 1, 2, 4, ... The paper has an additive mismatch of state-space
/// matrices; here it is one parameter of one channel. The weights here are the inverse covariances of the
/// compared values. The effect of the setpoints and measured disturbances of the record is computed, not
/// modelled as noise. The noise is that of the benchmark.
///
/// A CV is flagged if its part of c differs from that of the model by more than the limit of chi2 with alpha
/// divided among the CVs. The loop has a mismatch if the best theta explains the rest, by chi2 with alpha.
class Autocovariance final : public AssessmentMethod {
 public:
  /// A benchmark exists, because the method requires one.
  explicit Autocovariance(const AssessmentContext& context)
      : context_(context),
        study_(context.study),
        options_(context.study.assessment.of<AutocovarianceOptions>()),
        without_model_(why_not(context.study)) {
    lags_.push_back(0);
    for (Eigen::Index lag = 1; lag <= options_.largest_lag; lag *= 2)
      lags_.push_back(lag);
  }

  Assessment assess(const AssessedLoop& loop) override {
    if (without_model_)
      return Assessment::not_applicable(*without_model_);
    if (const Eigen::Index fewest = 4 * std::max<Eigen::Index>(lags_.back(), 10); loop.samples() < fewest)
      return Assessment::not_applicable(fmt::format("its autocovariances need {} samples or more", fewest));
    if (const std::optional<std::string> limit = limit_reached(loop))
      return Assessment::not_applicable(*limit);
    learn(loop);
    const Eigen::VectorXd c = loop_autocovariance(control_errors(loop, loop.y), lags_);
    const Eigen::VectorXd left = c - theoretical_autocovariance(*linear_, theory_->moves, lags_, nullptr);
    Assessment assessment;
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      judge_cv(cv, left, assessment);
    if (assessment.flagged)
      explain(c, assessment);
    return assessment;
  }

 private:
  /// Why the loops of this study have no linear theory; none if they have one.
  static std::optional<std::string> why_not(const Study& study) {
    if (study.controller.has_soft_limits())
      return "the controller holds CVs in ranges, and the loop is not linear";
    if (study.controller.has_targets())
      return "a target optimizer moves the MVs, and the loop is not linear";
    if (dither(study).size() > 0)
      return "test signals are added to the MVs";
    for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv)
      for (Eigen::Index mv = 0; mv < study.mv_count(); ++mv)
        if (study.plant.G(cv, mv).is_integrating())
          return "a channel of the model integrates";
    return std::nullopt;
  }

  std::optional<std::string> limit_reached(const AssessedLoop& loop) const {
    const AssessedLoop& whole = loop.from_start();
    const Eigen::Index end = loop.first + loop.samples();
    const auto reaches = [end](const Eigen::MatrixXd& signal, const Limits& hard, Eigen::Index row) {
      const double margin = std::isfinite(hard.upper(row) - hard.lower(row))
                                ? kAtLimit * (hard.upper(row) - hard.lower(row))
                                : 0.0;
      return signal.row(row).head(end).minCoeff() <= hard.lower(row) + margin ||
             signal.row(row).head(end).maxCoeff() >= hard.upper(row) - margin;
    };
    for (Eigen::Index mv = 0; mv < whole.u.rows(); ++mv)
      if (reaches(whole.u, study_.controller.mv_hard, mv))
        return fmt::format("{} reaches a hard limit, and the loop is not linear",
                           study_.plant.mvs[static_cast<std::size_t>(mv)].name);
    for (Eigen::Index cv = 0; cv < whole.y.rows(); ++cv)
      if (reaches(whole.y, study_.controller.cv_hard, cv))
        return fmt::format("{} reaches a hard limit, and the loop is not linear",
                           study_.plant.cvs[static_cast<std::size_t>(cv)].name);
    return std::nullopt;
  }

  /// What is known of loops, or windows of loops, with the same moves from outside.
  struct Theory {
    Eigen::MatrixXd d, y_set;  ///< signals that move the loops
    OutsideMoves moves;
    double noise_share = 2.0;
    Eigen::MatrixXd covariance;           ///< of the autocovariances, without a mismatch
    std::vector<GriddedFamily> families;  ///< empty until a loop has to be explained
  };

  /// Sets `theory_` to the theory of the loops with the same moves as this one. The theory of each window is
  /// kept as long as the moves stay the same.
  void learn(const AssessedLoop& loop) {
    const AssessedLoop& whole = loop.from_start();
    if (!linear_)
      linear_ =
          linear_loop(context_, *context_.benchmark,
                      std::min<Eigen::Index>(study_.simulation.samples, 2 * study_.sensitivity.samples));
    const Eigen::MatrixXd y_set =
        control_errors(whole, Eigen::MatrixXd::Zero(whole.y.rows(), whole.samples()));
    theory_ = &theories_[{loop.first, loop.samples()}];
    if (theory_->d.cols() == whole.samples() && theory_->d == whole.d && theory_->y_set == y_set)
      return;
    *theory_ = Theory{};
    theory_->d = whole.d;
    theory_->y_set = y_set;
    theory_->moves = outside_moves(context_, loop);
    theory_->noise_share =
        1.0 + static_cast<double>(loop.samples()) / static_cast<double>(context_.benchmark->samples());
    theory_->covariance =
        autocovariance_covariance(*linear_, theory_->moves, lags_, nullptr, theory_->noise_share);
  }

  void judge_cv(Eigen::Index cv, const Eigen::VectorXd& left, Assessment& assessment) const {
    const auto count = static_cast<Eigen::Index>(lags_.size());
    const SquaredDistance distance(theory_->covariance.block(cv * count, cv * count, count, count));
    const double chi2 = distance(left.segment(cv * count, count));
    const double score =
        chi2 / chi_squared_limit(count, options_.alpha / static_cast<double>(study_.cv_count()));
    const bool flagged = score > 1.0;
    assessment.cvs.push_back({flagged, score, FaultSource::none});
    assessment.numbers.push_back({"chi2", chi2, cv});
    assessment.flagged = assessment.flagged || flagged;
    assessment.score = std::fmax(assessment.score, score);
  }

  Eigen::VectorXd mean_of(const GriddedFamily& family, double x) const {
    const ChannelDifference changed = difference_of(family, x);
    return theoretical_autocovariance(*linear_, theory_->moves, lags_, &changed);
  }

  ChannelDifference difference_of(const GriddedFamily& family, double x) const {
    const auto [cv, mv] = family.channel;
    return channel_difference(study_.plant.G(cv, mv), family.family.channel(x), cv, mv,
                              study_.controller.sample_time, linear_->s.front().cols());
  }

  SquaredDistance distance_about(const FittedFamily& fit) const {
    const ChannelDifference changed = difference_of(*fit.of, fit.x);
    return SquaredDistance(
        autocovariance_covariance(*linear_, theory_->moves, lags_, &changed, theory_->noise_share));
  }

  static MismatchFamily finer(MismatchFamily family) {
    family.grid.points = kFiner * (family.grid.points - 1) + 1;
    return family;
  }

  void learn_families() {
    for (Eigen::Index cv = 0; cv < study_.cv_count(); ++cv)
      for (Eigen::Index mv = 0; mv < study_.mv_count(); ++mv) {
        if (study_.plant.G(cv, mv).is_zero())
          continue;
        for (MismatchFamily& family :
             mismatch_families(study_.plant.G(cv, mv), study_.controller.sample_time))
          theory_->families.push_back({{cv, mv}, finer(std::move(family)), {}});
      }
    for (GriddedFamily& each : theory_->families) {
      each.means.resize(theory_->covariance.rows(), each.family.grid.points);
      for (Eigen::Index point = 0; point < each.means.cols(); ++point)
        each.means.col(point) = mean_of(each, each.family.grid.at(point));
    }
  }

  /// The best point of the grid for each family.
  std::vector<FittedFamily> on_grid(const Eigen::VectorXd& c, const SquaredDistance& distance) const {
    std::vector<FittedFamily> fits;
    for (const GriddedFamily& each : theory_->families) {
      FittedFamily best{&each};
      for (Eigen::Index point = 0; point < each.means.cols(); ++point)
        if (const double at = distance(c - each.means.col(point)); at < best.distance) {
          best.distance = at;
          best.x = each.family.grid.at(point);
        }
      fits.push_back(best);
    }
    return fits;
  }

  /// The best mismatch of the family within `step` of the fit.
  FittedFamily refined(const FittedFamily& fit, double step, const Eigen::VectorXd& c,
                       const SquaredDistance& distance) const {
    const SearchGrid& grid = fit.of->family.grid;
    const MismatchObjective J = [&](double x) { return distance(c - mean_of(*fit.of, x)); };
    const double x =
        grid_minimiser(J, {std::max(grid.first, fit.x - step), std::min(grid.last, fit.x + step), 3});
    return {fit.of, x, J(x)};
  }

  static double grid_step(const FittedFamily& fit) {
    const SearchGrid& grid = fit.of->family.grid;
    return (grid.last - grid.first) / static_cast<double>(grid.points - 1);
  }

  /// The best mismatch. First each family is refined with the covariance of the model, since between two
  /// points of a grid the distance falls from thousands to a few. Then the best families are refined with the
  /// covariance of the best one. None if one of these covariances has no inverse.
  std::optional<FittedFamily> best_mismatch(const Eigen::VectorXd& c) {
    if (theory_->families.empty())
      learn_families();
    const SquaredDistance of_model(theory_->covariance);
    if (!of_model.is_usable())
      return std::nullopt;
    std::vector<FittedFamily> fits;
    for (const FittedFamily& fit : on_grid(c, of_model))
      fits.push_back(refined(fit, grid_step(fit), c, of_model));
    const auto nearer = [](const FittedFamily& a, const FittedFamily& b) { return a.distance < b.distance; };
    std::stable_sort(fits.begin(), fits.end(), nearer);
    const SquaredDistance distance = distance_about(fits.front());
    if (!distance.is_usable())
      return std::nullopt;
    fits.resize(std::min(fits.size(), kRefined));
    for (FittedFamily& fit : fits)
      fit = refined(fit, kSecondStep * grid_step(fit), c, distance);
    return *required_best_candidate("distances of the mismatches of a loop", fits,
                                    [](const FittedFamily& fit) { return -fit.distance; });
  }

  void explain(const Eigen::VectorXd& c, Assessment& assessment) {
    const std::optional<FittedFamily> best = best_mismatch(c);
    FaultSource source = FaultSource::none;
    if (best && best->of) {
      const SquaredDistance distance = distance_about(*best);
      const double misfit = distance.is_usable() ? distance(c - mean_of(*best->of, best->x)) : kInfinity;
      const double ratio = misfit / chi_squared_limit(c.size() - 1, options_.alpha);
      assessment.numbers.push_back({"misfit", ratio});
      source = ratio <= 1.0 || options_.unexplained == UnexplainedLoop::mismatch ? FaultSource::mpm
                                                                                 : FaultSource::ud;
      if (source == FaultSource::mpm)
        name_mismatch(c, *best, distance, misfit, assessment);
    }
    for (CvAssessment& cv : assessment.cvs)
      if (*cv.flagged)
        cv.source = source;
  }

  void name_mismatch(const Eigen::VectorXd& c, const FittedFamily& best, const SquaredDistance& distance,
                     double misfit, Assessment& assessment) const {
    const MismatchFamily& family = best.of->family;
    const MismatchObjective J = [&](double x) { return distance(c - mean_of(*best.of, x)); };
    const double level = misfit + chi_squared_limit(1, 1.0 - study_.aggregate.confidence);
    const double step = kIntervalStep * (family.grid.last - family.grid.first);
    assessment.flagged_channels.push_back(best.of->channel);
    assessment.named_mismatch = {best.of->channel, family.parameter, family.value(best.x),
                                 family.value(level_crossing(J, best.x, family.grid.first, step, level)),
                                 family.value(level_crossing(J, best.x, family.grid.last, step, level))};
  }

  const AssessmentContext& context_;
  const Study& study_;
  const AutocovarianceOptions& options_;
  std::optional<std::string> without_model_;  ///< why the method does not apply to this study
  std::vector<Eigen::Index> lags_;
  std::optional<LinearLoop> linear_;
  std::map<std::pair<Eigen::Index, Eigen::Index>, Theory> theories_;  ///< by first sample and samples
  Theory* theory_ = nullptr;                                          ///< theory of the current loop
};

}  // namespace

AssessmentMethodInfo autocovariance_method() {
  return {
      {.name = "autocovariance",
       .title = "after Wang et al. (2018), reconstructed",
       .verdict = "the autocovariances of some CV are not those of the controller on its own model",
       .requirements = {.benchmark = true, .moving_mvs = true, .nominal_loop = true},
       .locates_cvs = true,
       .names_channels = true,
       .tells_sources = true,
       .names_mismatches = true,
       .numbers = {{"chi2", NumberScope::cv,
                    "squared distance of the autocovariances from those of the model"},
                   {"misfit", NumberScope::loop,
                    "squared distance for all CVs from the best mismatch, over the threshold of chance"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Autocovariance>(context); },
      option_table<AutocovarianceOptions>(keys, "options of the autocovariances of a linear loop")};
}

}  // namespace mpm
