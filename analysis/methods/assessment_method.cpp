#include "analysis/methods/assessment_method.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/methods/broken_promise.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

/// Does some row of the record change?
bool moves(const Eigen::MatrixXd& record) {
  return record.cols() > 0 && (record.colwise() - record.col(0)).cwiseAbs().maxCoeff() > 0.0;
}

/// "37 of 400 samples of y2", for the CV with the most missing samples; empty if no sample is missing.
std::string missing_samples(const Study& study, const Eigen::MatrixXd& y) {
  const Eigen::VectorX<Eigen::Index> missing = y.array().isNaN().rowwise().count().matrix();
  Eigen::Index worst = 0;
  return missing.size() == 0 || missing.maxCoeff(&worst) == 0
             ? ""
             : fmt::format("{} of {} samples of {}", missing(worst), y.cols(),
                           study.plant.cvs[static_cast<std::size_t>(worst)].name);
}

/// Names a score of the verdict that is not a number; none if all are numbers. A CV without a verdict needs
/// no score.
std::optional<std::string> missing_score(const Study& study, const Assessment& assessment) {
  for (std::size_t cv = 0; cv < assessment.cvs.size(); ++cv)
    if (assessment.cvs[cv].flagged && std::isnan(assessment.cvs[cv].score))
      return fmt::format("its score of {} is not a number", study.plant.cvs[cv].name);
  return std::isnan(assessment.score) ? std::optional("its score is not a number") : std::nullopt;
}

/// Why no method can learn from the benchmark; none if they can.
std::optional<std::string> unusable_benchmark(const AssessmentContext& context) {
  if (!context.benchmark)
    return std::nullopt;
  if (const std::optional<std::string> found = out_of_proportion(context.study, *context.benchmark))
    return fmt::format("the benchmark has implausible values: {}", *found);
  return std::nullopt;
}

bool some_setpoint_moves(const AssessedLoop& loop) {
  for (const Eigen::Index cv : loop.setpoint_cvs())
    if (moves(loop.y_set.row(cv)))
      return true;
  return false;
}

}  // namespace

std::optional<std::string> unmet_requirement(const AssessmentRequirements& requirements,
                                             const AssessmentContext& context, const AssessedLoop& loop) {
  if (requirements.nominal_loop && !context.basis.sensitivity.is_known)
    return "it needs the controller on its own model, and the program that is the controller runs on the "
           "plant "
           "only";
  if (requirements.complete_record) {
    if (const std::string missing = missing_samples(context.study, loop.y); !missing.empty())
      return fmt::format("it needs a complete record, and {} are missing", missing);
    if (requirements.benchmark && context.benchmark && context.benchmark->y.hasNaN())
      return "it needs a complete benchmark period, and samples of it are missing";
  }
  const bool needs_setpoints = requirements.setpoints || requirements.moving_setpoints;
  if (needs_setpoints && loop.setpoint_cvs().empty())
    return "it needs setpoints, and the controller holds every CV in a range";
  if (requirements.moving_setpoints && !some_setpoint_moves(loop))
    return "it needs setpoints that move, and none does";
  if (requirements.benchmark && !context.benchmark)
    return "it needs a benchmark period, and none is known";
  if (requirements.moving_mvs && !moves(loop.u))
    return "it needs MVs that move, and none does";
  return std::nullopt;
}

std::optional<AssessmentMethodInfo> with_other_information(const AssessmentMethodInfo& method) {
  if (method.information == ModelInformation::unused)
    return std::nullopt;
  const bool gains = method.information == ModelInformation::nominal;
  AssessmentMethodInfo other = method;
  other.name += gains ? kCorrected : kUncorrected;
  other.title += gains ? ", y_sim corrected by the benchmark" : ", y_sim of the nominal model";
  other.information = gains ? ModelInformation::shown : ModelInformation::denied;
  other.options.reset();
  other.reduced.clear();
  return other;
}

std::vector<AssessmentMethodInfo> reduced_methods(const AssessmentMethodInfo& method) {
  std::vector<AssessmentMethodInfo> methods;
  for (const AssessmentMethodInfo::Reduced& each : method.reduced) {
    AssessmentMethodInfo& reduced = methods.emplace_back(method);
    reduced.name += ":" + each.end;
    reduced.title += ", " + each.title;
    reduced.make = each.make;
    reduced.options.reset();
    reduced.reduced.clear();
  }
  return methods;
}

Assessor::Assessor(const AssessmentMethodInfo& info, const AssessmentContext& context)
    : name_(info.name),
      requirements_(info.requirements),
      locates_cvs_(info.locates_cvs),
      information_(context.correction ? info.information : ModelInformation::nominal),
      context_(context),
      make_(info.make),
      unusable_(unusable_benchmark(context)),
      holds_analyses_(requirements_.complete_record && has_analysers(context.study.controller.analysers)) {
  const bool is_shown = information_ == ModelInformation::shown,
             is_denied = information_ == ModelInformation::denied;
  if (!holds_analyses_ && !is_shown && !is_denied)
    return;
  seen_ = std::make_unique<AssessmentContext>(context_);
  seen_->of_benchmark = std::make_shared<const DerivedValues>();
  if (is_denied)
    seen_->correction.reset();
  if (holds_analyses_ && seen_->benchmark) {
    of_benchmark_ = with_held(*context_.benchmark);
    seen_->benchmark = *of_benchmark_;
  }
}

std::shared_ptr<const AssessedLoop> Assessor::with_held(const AssessedLoop& loop) const {
  return with_analyses_held(
      context_.study, loop,
      requirements_.analyses_as_shown ? AnalysesHeld::from_shown : AnalysesHeld::from_taken);
}

Assessment Assessor::assess(const AssessedLoop& loop) {
  return *loop.derived.of<const Assessment>(name_, [&] { return std::make_shared<Assessment>(asked(loop)); });
}

Assessment Assessor::asked(const AssessedLoop& loop) {
  return holds_analyses_ ? asked_of_seen(*with_held(loop)) : asked_of_seen(loop);
}

Assessment Assessor::asked_of_seen(const AssessedLoop& loop) {
  if (const std::optional<std::string> unmet = unmet_requirement(requirements_, seen(), loop))
    return Assessment::not_applicable(*unmet);
  if (unusable_)
    return Assessment::failed(*unusable_);
  if (const std::optional<std::string> found = out_of_proportion(context_.study, loop))
    return Assessment::failed(fmt::format("the loop has implausible values: {}", *found));
  try {
    if (!method_)
      learn();
    Assessment assessment = answer_of_method(loop);
    assert(assessment.cvs.empty() || static_cast<Eigen::Index>(assessment.cvs.size()) == loop.y.rows());
    if (assessment.status != AssessmentStatus::ok)
      return assessment;
    if (const std::optional<std::string> score = missing_score(context_.study, assessment))
      return Assessment::failed(*score);
    if (assessment.flagged && locates_cvs_ && !assessment.worst_cv())
      return Assessment::failed("it flags the loop and names no CV");
    return assessment;
  } catch (const BrokenPromise&) {
    throw;
  } catch (const InputError& error) {
    return Assessment::failed(error.what());
  }
}

/// A method that is denied the correction must ask other methods without it as well, so their answers are
/// kept apart.
Assessment Assessor::answer_of_method(const AssessedLoop& loop) {
  if (information_ == ModelInformation::shown)
    return method_->assess(*context_.correction->corrected(loop));
  if (information_ != ModelInformation::denied)
    return method_->assess(loop);
  return method_->assess(*loop.derived.of<const AssessedLoop>(
      "uncorrected", [&] { return same_window(loop, loop.from_start()); }));
}

void Assessor::learn() {
  try {
    if (information_ == ModelInformation::shown && seen_->benchmark) {
      const std::string key = fmt::format("corrected benchmark, held {} {}", holds_analyses_,
                                          holds_analyses_ && requirements_.analyses_as_shown);
      of_benchmark_ = context_.of_benchmark->of<const AssessedLoop>(
          key, [&] { return context_.correction->corrected(*seen_->benchmark); });
      seen_->benchmark = *of_benchmark_;
    }
    method_ = make_(seen());
  } catch (const BrokenPromise&) {
    throw;
  } catch (const InputError& error) {
    unusable_ = error.what();
    throw;
  }
}

std::shared_ptr<Assessor> shared_assessor(const AssessmentMethodInfo& info,
                                          const AssessmentContext& context) {
  return context.derived.of<Assessor>(info.name, [&] { return std::make_shared<Assessor>(info, context); });
}

}  // namespace mpm
