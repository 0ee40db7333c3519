#include "analysis/methods/method_panel.hpp"

#include <algorithm>
#include <utility>

#include "analysis/methods/method_table.hpp"
#include "base/system/thread_clock.hpp"

namespace mpm {
MethodPanel::MethodPanel(const Study& study, AssessmentContext context,
                         const std::vector<std::string>& methods)
    : study_(study), context_(std::move(context)), forms_(assessment_forms(study, methods)) {
  for (const auto& form : forms_)
    assessors_.emplace_back(method_table(study.assessment).method(form->method().name), context_);
}

AssessmentRecord MethodPanel::assessed(std::size_t method, const AssessedLoop& loop, const Own* own) {
  if (own == nullptr)
    return timed(method, assessors_[method], loop);
  // The controller or the excitation is another one; the benchmark is still what the study was designed for.
  const AssessmentContext context{
      own->study,          own->basis,         context_.factory, context_.benchmark, context_.benchmark_study,
      context_.correction, context_.not_learnt};
  Assessor assessor(method_table(own->study.assessment).method(forms_[method]->method().name), context);
  return timed(method, assessor, loop);
}

AssessmentRecord MethodPanel::timed(std::size_t method, Assessor& assessor, const AssessedLoop& loop) const {
  const double start = thread_seconds();
  AssessmentRecord record = kept(forms_[method], assessor.assess(loop));
  record.milliseconds = 1e3 * (thread_seconds() - start);
  if (const auto& monitoring = study_.monitoring; monitoring && record.answered())
    for (int window = 0; window < monitoring->count(static_cast<int>(loop.samples())); ++window)
      add_window(record, window,
                 assessor.assess(window_of(loop, monitoring->begin(window), monitoring->window)));
  return record;
}

std::vector<AssessmentRecord> MethodPanel::assess(const AssessedLoop& loop, const Own* own) {
  std::vector<AssessmentRecord> records;
  for (std::size_t method = 0; method < forms_.size(); ++method)
    records.push_back(assessed(method, loop, own));
  return records;
}

std::optional<AssessmentRecord> MethodPanel::assess_by(std::string_view method, const AssessedLoop& loop,
                                                       const Own* own) {
  const auto form = std::find_if(forms_.begin(), forms_.end(),
                                 [&](const auto& each) { return each->method().name == method; });
  if (form == forms_.end())
    return std::nullopt;
  return assessed(static_cast<std::size_t>(form - forms_.begin()), loop, own);
}

}  // namespace mpm
