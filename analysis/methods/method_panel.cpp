#include "analysis/methods/method_panel.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include "analysis/methods/method_table.hpp"

namespace mpm {
namespace {

/// Processor time of this thread, s.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

MethodPanel::MethodPanel(const Study& study, const BasisCase& basis, const std::vector<std::string>& methods,
                         QpSolverFactory factory)
    : factory_(std::move(factory)),
      context_(assessment_context(study, basis, factory_)),
      forms_(assessment_forms(study, methods)) {
  for (const auto& form : forms_)
    assessors_.emplace_back(assessment_method(form->method().name), context_);
}

AssessmentRecord MethodPanel::assessed(std::size_t method, Assessor& assessor,
                                       const AssessedLoop& loop) const {
  const double start = thread_seconds();
  AssessmentRecord record = kept(forms_[method], assessor.assess(loop));
  record.seconds = thread_seconds() - start;
  return record;
}

std::vector<AssessmentRecord> MethodPanel::assess(const AssessedLoop& loop, const TunedBasis* own) {
  std::vector<AssessmentRecord> records;
  for (const auto& form : forms_)
    records.push_back(*assess_by(form->method().name, loop, own));
  return records;
}

std::optional<AssessmentRecord> MethodPanel::assess_by(std::string_view method, const AssessedLoop& loop,
                                                       const TunedBasis* own) {
  const auto form = std::find_if(forms_.begin(), forms_.end(),
                                 [&](const auto& each) { return each->method().name == method; });
  if (form == forms_.end())
    return std::nullopt;
  const auto place = static_cast<std::size_t>(form - forms_.begin());
  if (own == nullptr)
    return assessed(place, assessors_[place], loop);
  // The controller is another one, and its S0 with it; the benchmark is still what the study was designed
  // for.
  const AssessmentContext context{own->study, own->basis, factory_, context_.benchmark};
  Assessor assessor(assessment_method(method), context);
  return assessed(place, assessor, loop);
}

std::vector<AssessmentRecord> MethodPanel::unassessed() const {
  std::vector<AssessmentRecord> records(forms_.size());
  for (std::size_t method = 0; method < forms_.size(); ++method)
    records[method].form = forms_[method];
  return records;
}

}  // namespace mpm
