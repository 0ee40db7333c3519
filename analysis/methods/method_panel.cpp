#include "analysis/methods/method_panel.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "analysis/methods/method_table.hpp"
#include "base/system/thread_clock.hpp"

namespace mpm {
namespace {

/// The answer of a method, with its processor time.
AssessmentRecord timed(const std::shared_ptr<const AssessmentForm>& form, Assessor& assessor,
                       const AssessedLoop& loop) {
  const double start = thread_seconds();
  AssessmentRecord record = kept(form, assessor.assess(loop));
  record.milliseconds = 1e3 * (thread_seconds() - start);
  return record;
}

/// A store of derived values. The first caller that asks for a value pays for its time.
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
    // The controller or the excitation differs; the benchmark still shows the controller for which the study
    // was designed.
    const bool same_basis = &own->basis == &context_.basis;
    of_own.emplace(AssessmentContext{own->study, own->basis, context_.factory, context_.benchmark,
                                     context_.benchmark_study, context_.correction,
                                     same_basis ? context_.of_benchmark : kept_values()});
    of_own->derived.keep(PaidBy::first);
  }
  const AssessmentContext& context = of_own ? *of_own : context_;
  const MethodTable& table = method_table(own != nullptr ? own->study.assessment : study_.assessment);
  AssessedLoop record = loop;
  record.derived.keep(PaidBy::each);
  std::vector<std::shared_ptr<Assessor>> assessors;
  std::vector<AssessmentRecord> records;
  for (const auto& form : forms) {
    assessors.push_back(shared_assessor(table.method(form->method().name), context));
    records.push_back(timed(form, *assessors.back(), record));
  }
  // Values derived from a window may be as large as the record; they are released with the window.
  const int windows = study_.monitoring ? study_.monitoring->count(static_cast<int>(loop.samples())) : 0;
  for (int number = 0; number < windows; ++number) {
    AssessedLoop window = window_of(record, study_.monitoring->begin(number), study_.monitoring->window);
    window.derived.keep(PaidBy::each);
    for (std::size_t method = 0; method < records.size(); ++method)
      if (records[method].answered())
        add_window(records[method], number, assessors[method]->assess(window));
  }
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
