#include "analysis/methods/ours/counterfactual_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/ours/base_noise.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/statistics/student.hpp"
#include "analysis/statistics/variance.hpp"
#include "analysis/statistics/washout.hpp"
#include "base/non_finite.hpp"
#include "plants/analyser.hpp"
#include "scenarios/loop/record_rows.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr double kLeastNominalShare = 0.1;
constexpr std::uint64_t kNoiseSeed = 47;

/// e = y - y_sim of the whole record, its gaps closed.
Eigen::MatrixXd errors_of(const Study& study, const AssessedLoop& whole) {
  return from_washout(study, whole.y - whole.y_sim);
}

/// Moves each row `samples` later, along straight lines.
Eigen::MatrixXd later_rows(const Eigen::MatrixXd& y, double samples) {
  if (samples == 0.0)
    return y;
  Eigen::MatrixXd later(y.rows(), y.cols());
  for (Eigen::Index row = 0; row < y.rows(); ++row)
    later.row(row) = late_by(y.row(row), samples);
  return later;
}

}  // namespace

CounterfactualLoop::CounterfactualLoop(const AssessmentContext& context)
    : study_(context.study),
      learnt_(learnt_model(context)),
      plant_(learnt_ ? learnt_->plant() : context.study.plant.G),
      late_(learnt_ ? learnt_->late() / context.study.controller.sample_time : 0.0),
      factory_(context.factory),
      y_set_(setpoints(context.study)),
      dither_(dither(context.study)),
      noise_(*context.of_benchmark->of<const Eigen::VectorXd>("noise of counterfactual", [&] {
        return std::make_shared<Eigen::VectorXd>(noise_of_benchmark(context));
      })) {}

std::shared_ptr<CounterfactualLoop> CounterfactualLoop::of_context(const AssessmentContext& context) {
  return context.derived.of<CounterfactualLoop>(
      "", [&] { return std::make_shared<CounterfactualLoop>(context); });
}

/// v, from the benchmark and the same loop without noise; empty if the latter does not run to its end.
Eigen::VectorXd CounterfactualLoop::noise_of_benchmark(const AssessmentContext& context) const {
  const Eigen::MatrixXd y_basis = gaps_closed(recorded_basis(context));
  const Study& of_basis = context.study_of_benchmark();
  const SetpointTrajectories centres = variance_centres(of_basis, 0, y_basis.cols());
  const Trajectory nominal =
      simulated(of_basis, as_taken(of_basis.controller.md_analysers, context.basis.trajectory.d),
                setpoints(of_basis), Eigen::MatrixXd::Zero(y_basis.rows(), y_basis.cols()));
  return nominal.status == ControlStatus::ok
             ? noise_variance(variances(y_basis, centres), variances(nominal.y, centres))
             : Eigen::VectorXd();
}

CounterfactualLoop::Impact CounterfactualLoop::impact(const AssessedLoop& loop) {
  if (noise_.size() == 0)
    return {Assessment::failed("the controller does not run on its own model without noise")};
  const Trajectory& nominal = undisturbed(loop.from_start());
  if (nominal.status != ControlStatus::ok)
    return {Assessment::failed("the controller does not run on its own model under these disturbances")};
  Indices found{indices(loop, nominal.y, noise_), {}};
  found.chance.setZero(found.ivar.size());
  if (learnt_ && outside(found.ivar))
    if (std::optional<Indices> under_noise = indices_under_noise(loop))
      found = std::move(*under_noise);
  Assessment assessment;
  for (Eigen::Index cv = 0; cv < found.ivar.size(); ++cv) {
    const double ivar = found.ivar(cv), chance = found.chance(cv);
    assessment.score = std::fmax(assessment.score, distance(ivar, chance));
    assessment.flagged = assessment.flagged || has_impact(ivar, chance);
    assessment.numbers.push_back({"ivar", ivar, cv});
  }
  return {std::move(assessment), std::move(found.chance)};
}

Eigen::VectorXd CounterfactualLoop::ivar_diag(const AssessedLoop& loop, const Impact& impact) const {
  const AssessedLoop& whole = loop.from_start();
  const bool is_drawn = impact.chance.size() > 0 && impact.chance.maxCoeff() > 0.0;
  const Eigen::VectorXd added = is_drawn ? Eigen::VectorXd::Zero(whole.y.rows()) : noise_;
  Eigen::VectorXd found(whole.y.rows());
  for (Eigen::Index cv = 0; cv < found.size(); ++cv) {
    const auto y = whole.derived.of<const Eigen::MatrixXd>(
        fmt::format("y0_diag of CV {}, noise {}", cv, is_drawn),
        [&] { return std::make_shared<Eigen::MatrixXd>(disturbed_output(whole, cv, is_drawn)); });
    found(cv) = y->size() > 0 ? indices(loop, *y, added)(cv) : kNaN;
  }
  return found;
}

std::vector<CvAssessment> CounterfactualLoop::located(const Eigen::VectorXd& ivar_diag,
                                                      const Impact& impact) const {
  const bool has_none = ivar_diag.array().isNaN().all();
  std::vector<CvAssessment> cvs(static_cast<std::size_t>(ivar_diag.size()));
  for (Eigen::Index cv = 0; cv < ivar_diag.size(); ++cv) {
    const double ivar = has_none ? impact.assessment.number("ivar", cv) : ivar_diag(cv);
    if (!std::isnan(ivar))
      cvs[static_cast<std::size_t>(cv)] = {has_impact(ivar, impact.chance(cv)),
                                           distance(ivar, impact.chance(cv))};
  }
  return cvs;
}

bool CounterfactualLoop::outside(const Eigen::VectorXd& ivar) const {
  return std::any_of(ivar.begin(), ivar.end(),
                     [&](double each) { return study_.diagnosis.has_impact(each); });
}

bool CounterfactualLoop::has_impact(double ivar, double chance) const {
  return study_.diagnosis.has_impact(ivar) && std::abs(std::log(ivar)) > chance;
}

/// The distance of a variance index from 1, as the study measures it to locate a CV, as far as chance does
/// not explain it.
double CounterfactualLoop::distance(double ivar, double chance) const {
  const DiagnosisOptions& options = study_.diagnosis;
  const double from_one = distance_from_one(ivar, options.location_distance);
  if (chance == 0.0)
    return from_one;
  const double edge =
      distance_from_one(ivar > 1.0 ? options.impact_upper : options.impact_lower, options.location_distance);
  return std::min(from_one, edge * std::abs(std::log(ivar)) / chance);
}

/// A draw of the noise that the benchmark has shown, ny x N, to be added to the outputs.
Eigen::MatrixXd CounterfactualLoop::drawn_noise_of(Eigen::Index samples, int draw) const {
  RandomStream random(kNoiseSeed, static_cast<std::uint64_t>(draw), StreamId::background);
  Eigen::MatrixXd noise(study_.cv_count(), samples);
  for (Eigen::Index cv = 0; cv < noise.rows(); ++cv)
    noise.row(cv) = drawn_noise(learnt_->of(cv).noise(), samples, random);
  return from_washout(study_, noise);
}

/// y0 of the whole record under each draw of the noise; empty if a loop does not run to its end.
const std::vector<Eigen::MatrixXd>& CounterfactualLoop::outputs_under_noise(const Eigen::MatrixXd& d) {
  if (drawn_d_.cols() == d.cols() && drawn_d_ == d)  // no MDs: 0 x N
    return drawn_y_;
  drawn_d_ = d;
  drawn_y_.clear();
  for (int draw = 0; draw < kNoiseDraws; ++draw) {
    Trajectory nominal = simulated(study_, d, y_set_, drawn_noise_of(d.cols(), draw));
    if (nominal.status != ControlStatus::ok) {
      drawn_y_.clear();
      break;
    }
    drawn_y_.push_back(std::move(nominal.y));
  }
  return drawn_y_;
}

/// Ivar with the mean of the nominal variance over draws of the noise; none if a loop does not run to its
/// end.
std::optional<CounterfactualLoop::Indices> CounterfactualLoop::indices_under_noise(const AssessedLoop& loop) {
  const AssessedLoop& whole = loop.from_start();
  const SetpointTrajectories centres = variance_centres(study_, loop.first, loop.samples());
  const std::vector<Eigen::MatrixXd>& outputs = outputs_under_noise(whole.d);
  if (outputs.empty())
    return std::nullopt;
  Eigen::ArrayXXd drawn(whole.y.rows(), kNoiseDraws);
  for (int draw = 0; draw < kNoiseDraws; ++draw)
    drawn.col(draw) = variances(loop.in_window(outputs[static_cast<std::size_t>(draw)]), centres);
  constexpr double n = kNoiseDraws;
  const double tails = kChance / static_cast<double>(drawn.rows());
  const double t = student_quantile(1.0 - 0.5 * tails, n - 1.0);
  const Eigen::ArrayXXd logs = drawn.log();
  const Eigen::ArrayXd squares = (logs.colwise() - logs.rowwise().mean()).square().rowwise().sum();
  const Eigen::VectorXd chance = t * (squares * (1.0 + 1.0 / n) / (n - 1.0)).sqrt();
  const Eigen::MatrixXd y = loop.in_window(from_washout(study_, whole.y_sim) + errors_of(study_, whole));
  return Indices{variances(y, centres).cwiseQuotient(drawn.rowwise().mean().matrix()), chance};
}

/// v of each CV from the variances of the benchmark and of the same loop without noise.
Eigen::VectorXd CounterfactualLoop::noise_variance(const Eigen::VectorXd& noisy,
                                                   const Eigen::VectorXd& quiet) const {
  switch (study_.assessment.of<CounterfactualOptions>().noise) {
    case NoiseVariance::difference:
      return noisy - quiet;
    case NoiseVariance::positive:
      return (noisy - quiet).cwiseMax(0.0);
    case NoiseVariance::none:
      break;
  }
  return Eigen::VectorXd::Zero(noisy.size());
}

/// The loop of the controller on its model under the disturbances `d`, with `errors` added to the outputs;
/// errors and outputs are timed like the rows of the record.
Trajectory CounterfactualLoop::simulated(const Study& study, const Eigen::MatrixXd& d,
                                         const Eigen::MatrixXd& y_set, const Eigen::MatrixXd& errors) const {
  // Straight lines between samples would take away half of their noise.
  const Eigen::MatrixXd y_d = later_rows(errors, -std::trunc(late_));
  Trajectory loop = run_closed_loop(study, plant_,
                                    {.d = d,
                                     .noise = Eigen::MatrixXd::Zero(errors.rows(), errors.cols()),
                                     .y_d = y_d,
                                     .y_set = y_set,
                                     .dither = dither_},
                                    factory_);
  if (late_ != 0.0 && loop.status == ControlStatus::ok)
    loop.y = later_rows(loop.y - y_d, late_) + errors;
  return loop;
}

/// The same without errors. The last loop is kept, since the windows of a record need the same one, and so do
/// all records with the disturbances of the study.
const Trajectory& CounterfactualLoop::undisturbed(const AssessedLoop& whole) {
  if (nominal_.y.cols() != whole.samples() || nominal_d_ != whole.d) {
    nominal_d_ = whole.d;
    nominal_ = simulated(study_, whole.d, y_set_, Eigen::MatrixXd::Zero(whole.y.rows(), whole.y.cols()));
  }
  return nominal_;
}

/// y0_diag of the record for CV `cv`, with the first draw of the noise in this CV if `is_drawn`; empty if the
/// loop does not run to its end.
Eigen::MatrixXd CounterfactualLoop::disturbed_output(const AssessedLoop& whole, Eigen::Index cv,
                                                     bool is_drawn) const {
  Eigen::MatrixXd errors = learnt_ ? errors_of(study_, *learnt_->corrected(whole)) : errors_of(study_, whole);
  if (is_drawn)
    errors.row(cv) = drawn_noise_of(errors.cols(), 0).row(cv);
  else
    errors.row(cv).setZero();
  Trajectory nominal = simulated(study_, whole.d, y_set_, errors);
  return nominal.status == ControlStatus::ok ? std::move(nominal.y) : Eigen::MatrixXd();
}

/// var y / (var y0 + v) of each CV, ny.
Eigen::VectorXd CounterfactualLoop::indices(const AssessedLoop& loop, const Eigen::MatrixXd& nominal,
                                            const Eigen::Ref<const Eigen::VectorXd>& added) const {
  const AssessedLoop& whole = loop.from_start();
  const Eigen::MatrixXd y = loop.in_window(from_washout(study_, whole.y_sim) + errors_of(study_, whole));
  const SetpointTrajectories centres = variance_centres(study_, loop.first, loop.samples());
  const Eigen::ArrayXd of_nominal = variance_indices(y, loop.in_window(nominal), centres);
  // A v below 0 can outweigh a y0 that hardly moves, so var y0 + v counts as at least a tenth of var y0.
  const Eigen::ArrayXd inverse = of_nominal.inverse() + added.array() / variances(y, centres).array();
  return inverse.max(kLeastNominalShare * of_nominal.inverse()).inverse();
}

}  // namespace mpm
