#include "analysis/methods/method_panel.hpp"

#include <algorithm>
#include <utility>

#include "analysis/methods/method_table.hpp"
#include "base/system/thread_clock.hpp"

namespace mpm {
namespace {

/// The answer of a method on the record, with its time, and on the windows.
AssessmentRecord timed(const std::shared_ptr<const AssessmentForm>& form, const Study& study,
                       Assessor& assessor, const AssessedLoop& loop) {
  const double start = thread_seconds();
  AssessmentRecord record = kept(form, assessor.assess(loop));
  record.milliseconds = 1e3 * (thread_seconds() - start);
  if (const auto& monitoring = study.monitoring; monitoring && record.answered())
    for (int window = 0; window < monitoring->count(static_cast<int>(loop.samples())); ++window)
      add_window(record, window,
                 assessor.assess(*derived_window(loop, monitoring->begin(window), monitoring->window)));
  return record;
}

/// A store of values, each paid by the first who asks for it.
std::shared_ptr<const DerivedValues> kept_values() {
  auto values = std::make_shared<DerivedValues>();
  values->keep(PaidBy::first);
  return values;
}

}  // namespace

MethodPanel::MethodPanel(const Study& study, AssessmentContext context,
                         const std::vector<std::string>& methods)
    : study_(study), context_(std::move(context)), forms_(assessment_forms(study, methods)) {
  context_.derived.keep(PaidBy::first);
  context_.of_benchmark = kept_values();
}

std::vector<AssessmentRecord> MethodPanel::assessed(const AssessmentForms& forms, const AssessedLoop& loop,
                                                    const Own* own) const {
  std::optional<AssessmentContext> of_own;
  if (own != nullptr) {
    // The controller or the excitation is another one; the benchmark is still what the study was designed
    // for.
    const bool same_basis = &own->basis == &context_.basis;
    of_own.emplace(AssessmentContext{own->study, own->basis, context_.factory, context_.benchmark,
                                     context_.benchmark_study, context_.correction, context_.not_learnt,
                                     same_basis ? context_.of_benchmark : kept_values()});
    of_own->derived.keep(PaidBy::first);
  }
  const AssessmentContext& context = of_own ? *of_own : context_;
  const MethodTable& table = method_table(own != nullptr ? own->study.assessment : study_.assessment);
  AssessedLoop record = loop;
  record.derived.keep(PaidBy::each);
  std::vector<AssessmentRecord> records;
  for (const auto& form : forms)
    records.push_back(
        timed(form, study_, *shared_assessor(table.method(form->method().name), context), record));
  return records;
}

std::vector<AssessmentRecord> MethodPanel::assess(const AssessedLoop& loop, const Own* own) {
  return assessed(forms_, loop, own);
}

std::optional<AssessmentRecord> MethodPanel::assess_by(std::string_view method, const AssessedLoop& loop,
                                                       const Own* own) {
  const auto form = std::find_if(forms_.begin(), forms_.end(),
                                 [&](const auto& each) { return each->method().name == method; });
  if (form == forms_.end())
    return std::nullopt;
  return assessed({*form}, loop, own).front();
}

}  // namespace mpm
