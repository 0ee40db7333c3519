#include "analysis/assessment/comparison.hpp"

#include <algorithm>
#include <ctime>
#include <optional>
#include <utility>

#include "analysis/assessment/method_table.hpp"

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

}  // namespace

MethodPanel::MethodPanel(const Study& study, const BasisCase& basis, const std::vector<std::string>& methods,
                         QpSolverFactory factory)
    : study_(study),
      basis_(basis),
      factory_(std::move(factory)),
      context_(assessment_context(study, basis, factory_)) {
  for (const std::string& method : methods)
    assessors_.emplace_back(assessment_method(method), context_);
}

ComparedLoop MethodPanel::assess(const ExperimentRecord& record, std::vector<std::string>& reasons) {
  const AssessedLoop loop = assessed_loop(
      study_, basis_.point,
      record.loop ? record.loop->trajectory : simulate_experiment(study_, record.draw, factory_));
  ComparedLoop compared;
  compared.experiment = record.draw.index;
  reasons.resize(assessors_.size());
  for (std::size_t m = 0; m < assessors_.size(); ++m)
    compared.verdicts.push_back(verdict_of(assessors_[m], loop, reasons[m]));
  return compared;
}

}  // namespace mpm
