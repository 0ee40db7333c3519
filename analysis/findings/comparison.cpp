#include "analysis/findings/comparison.hpp"

#include <algorithm>
#include <ctime>
#include <optional>
#include <utility>

#include "analysis/basis/own_basis.hpp"
#include "analysis/methods/method_table.hpp"

namespace mpm {
namespace {

/// Processor time of this thread, s.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The channels by CV and MV, each once.
std::vector<Channel> in_order(std::vector<Channel> channels) {
  std::sort(channels.begin(), channels.end(),
            [](const Channel& a, const Channel& b) { return a.cv != b.cv ? a.cv < b.cv : a.mv < b.mv; });
  channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
  return channels;
}

MethodVerdict verdict_of(Assessor& assessor, const AssessedLoop& loop, std::string& reason) {
  const double start = thread_seconds();
  Assessment assessment = assessor.assess(loop);
  MethodVerdict verdict;
  verdict.seconds = thread_seconds() - start;
  verdict.status = assessment.status;
  reason = std::move(assessment.reason);
  if (assessment.status != AssessmentStatus::ok)
    return verdict;
  verdict.flagged = assessment.flagged;
  verdict.score = assessment.score;
  if (const std::optional<Eigen::Index> worst = assessment.worst_cv()) {
    verdict.located_cv = *worst;
    verdict.source = assessment.cvs[static_cast<std::size_t>(*worst)].source;
  }
  verdict.flagged_channels = in_order(std::move(assessment.flagged_channels));
  return verdict;
}

ComparedLoop verdicts(std::int64_t experiment, const AssessedLoop& loop, std::vector<Assessor>& assessors,
                      std::vector<std::string>& reasons) {
  ComparedLoop compared;
  compared.experiment = experiment;
  reasons.resize(assessors.size());
  for (std::size_t m = 0; m < assessors.size(); ++m)
    compared.verdicts.push_back(verdict_of(assessors[m], loop, reasons[m]));
  return compared;
}

/// What there is to say of a loop that no method can look at.
ComparedLoop unanswered(std::int64_t experiment, std::size_t methods, const std::string& reason,
                        std::vector<std::string>& reasons) {
  reasons.assign(methods, reason);
  return {experiment, std::vector<MethodVerdict>(methods)};
}

}  // namespace

MethodPanel::MethodPanel(const Study& study, const BasisCase& basis, const std::vector<std::string>& methods,
                         QpSolverFactory factory)
    : study_(study),
      basis_(basis),
      factory_(std::move(factory)),
      context_(assessment_context(study, basis, factory_)) {
  for (const std::string& method : methods)
    methods_.push_back(assessment_method(method));
  assessors_ = assessors_for(context_);
}

std::vector<Assessor> MethodPanel::assessors_for(const AssessmentContext& context) const {
  std::vector<Assessor> assessors;
  for (const AssessmentMethodInfo& method : methods_)
    assessors.emplace_back(method, context);
  return assessors;
}

ComparedLoop MethodPanel::assess(const ExperimentRecord& record, std::vector<std::string>& reasons) {
  const Trajectory trajectory =
      record.loop ? record.loop->trajectory : simulate_experiment(study_, record.draw, factory_);
  if (trajectory.status != ControlStatus::ok)
    return unanswered(record.draw.index, methods_.size(), "the loop does not run to its end", reasons);
  const std::optional<OwnBasis> own = own_basis(study_, record.draw, factory_);
  if (own && own->basis.trajectory.status != ControlStatus::ok)
    return unanswered(record.draw.index, methods_.size(),
                      "its controller has no S0 of its own: " + own->basis.explanation, reasons);
  if (!own)
    return verdicts(record.draw.index, assessed_loop(study_, basis_.point, trajectory), assessors_, reasons);
  // The controller is another one, and its S0 with it; the benchmark is still what the study was designed
  // for.
  const AssessmentContext context{own->study, own->basis, factory_, context_.benchmark};
  std::vector<Assessor> assessors = assessors_for(context);
  return verdicts(record.draw.index, assessed_loop(own->study, own->basis.point, trajectory), assessors,
                  reasons);
}

}  // namespace mpm
